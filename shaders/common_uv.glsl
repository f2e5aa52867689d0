// Images have row 0 on top and texture coordinates have v upwards.
vec2 image_uv(mat3 transform, vec2 uv) {
    uv = (transform * vec3(uv, 1.0)).xy;
    return vec2(uv.x, 1.0 - uv.y);
}
