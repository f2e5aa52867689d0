// Stands for the text of a material's own shader.
void surface(inout Surface s) {}
