"""Without and with bloom: a bright light from behind that glows around what it grazes, the paper's figure 6b.

usage: figure_6b_bloom.py [FOLDER]    FOLDER (or $EASYPBR_TEST_DATA) holds head.obj. Writes figure_6b_bloom.png.
"""
import os
import sys
from pathlib import Path

import numpy as np

import easypbr
from easypbr import *

data = Path(sys.argv[1] if len(sys.argv) > 1 else os.environ["EASYPBR_TEST_DATA"])
head = Mesh(data / "head.obj")
head.material = Material(base_color="#b9b4ae", roughness=0.35)
Scene.show(head, "head")
view = Viewer((600, 600), {"background": {"color": "#101014"}, "tonemap": {"exposure": 0.8}})
view.add_light("back", "directional", direction=(0.75, -0.45, 0.6), intensity=30)
plain = view.render(samples=32)
view.settings.update({"bloom": {"enabled": True, "intensity": 0.5}})
easypbr.save_image(np.hstack([plain, view.render(samples=32)]), "figure_6b_bloom.png")
