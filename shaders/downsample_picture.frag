// The next mip level of a picture: 4 x 4 texels weighted (1 3 3 1) in each direction by four bilinear fetches, so that
// enlarged levels show no squares.
uniform sampler2D u_finer;
uniform vec2 u_size;  // of the target

layout(location = 0) out vec4 o_color;

void main() {
    vec2 uv = gl_FragCoord.xy / u_size, step = 0.25 / u_size;
    vec4 sum = vec4(0.0);
    sum += textureLod(u_finer, uv + step * vec2(-1.5, -1.5), 0.0);
    sum += textureLod(u_finer, uv + step * vec2(1.5, -1.5), 0.0);
    sum += textureLod(u_finer, uv + step * vec2(-1.5, 1.5), 0.0);
    sum += textureLod(u_finer, uv + step * vec2(1.5, 1.5), 0.0);
    o_color = 0.25 * sum;
}
