"""A head with physically based shading, soft shadows and bloom, in fewer than ten lines: the paper's figure 1.

usage: figure_1_head.py [FOLDER]    FOLDER (or $EASYPBR_TEST_DATA) holds head.obj. Writes figure_1_head.png.
"""
import os
import sys
from pathlib import Path

from easypbr import *

data = Path(sys.argv[1] if len(sys.argv) > 1 else os.environ["EASYPBR_TEST_DATA"])
view = Viewer((800, 800))
head = Mesh(data / "head.obj")
head.material = Material(base_color="#c98f74", roughness=0.45)
Scene.show(head, "head")
view.settings.bloom.enabled = True
view.recorder.record("figure_1_head.png", samples=64)
