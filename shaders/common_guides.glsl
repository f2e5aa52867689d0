// What surfaces are, for denoisers, in four numbers a pixel: whole numbers of 24 bits are exact in single precision.

// Three numbers from 0 to 1, of 8 bits each.
float packed_bytes(vec3 v) {
    vec3 bytes = floor(clamp(v, 0.0, 1.0) * 255.0 + 0.5);
    return bytes.x + bytes.y * 256.0 + bytes.z * 65536.0;
}

// Each from 0 to 255.
vec3 unpacked_bytes(float packed) {
    int bits = int(packed);
    return vec3(float(bits & 255), float((bits >> 8) & 255), float(bits >> 16));
}
