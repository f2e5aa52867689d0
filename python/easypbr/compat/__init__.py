"""Other libraries' interfaces, drawn by EasyPBR: pyrender's, in easypbr.compat.pyrender."""
