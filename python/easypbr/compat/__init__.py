"""Other libraries' interfaces, drawn by EasyPBR: pyrender's, in easypbr.compat.pyrender; the first EasyPBR's, in easypbr.compat.easypbr1."""
