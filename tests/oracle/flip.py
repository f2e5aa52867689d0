"""Mean FLIP (Andersson et al. 2020) of two 8-bit pictures within a mask, in the environment that scripts/oracle.sh makes:

    .venv-oracle/bin/python tests/oracle/flip.py FILE.npz      reference, test (height x width x 3, uint8), mask (bool)

Pixels outside of the mask are made equal, so that they neither count nor reach in. 67 pixels per degree.
"""
import sys

import flip_evaluator
import numpy as np

arrays = np.load(sys.argv[1])
mask = arrays["mask"]
reference, test = ((np.where(mask[:, :, None], arrays[name], 0) / 255).astype(np.float32) for name in ("reference", "test"))
errors, _, _ = flip_evaluator.evaluate(reference, test, "LDR", inputsRGB=True, applyMagma=False, parameters={"ppd": 67.0})
print(float(np.asarray(errors).reshape(mask.shape)[mask].mean()))
