"""What other libraries draw, as meshes. Objects are recognised by their attributes; none of the libraries is imported."""
