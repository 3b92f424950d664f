import { ShaderMaterial, type Texture } from "three";
import { AMBIENT } from "../light";

/** Texels of a slot: three rows of the matrix, then grey, alpha and colour. */
export const TEXELS_PER_SLOT = 4;
export const SLOTS_PER_ROW = 64;

const VERTEX = /* glsl */ `
  attribute float slot;
  attribute vec3 color;
  uniform highp sampler2D slots;
  varying vec4 vColor;
  vec4 texel(int part) {
    int index = int(slot + 0.5);
    return texelFetch(slots, ivec2((index % ${SLOTS_PER_ROW}) * ${TEXELS_PER_SLOT} + part, index / ${SLOTS_PER_ROW}), 0);
  }
  vec3 unpacked(float rgb) {
    return vec3((uvec3(rgb) >> uvec3(16u, 8u, 0u)) & 255u) * (1.0 / 255.0);
  }
  void main() {
    vec4 row0 = texel(0), row1 = texel(1), row2 = texel(2), look = texel(3);
    mat3 turn = transpose(mat3(row0.xyz, row1.xyz, row2.xyz));
    vec3 across = normal / vec3(dot(turn[0], turn[0]), dot(turn[1], turn[1]), dot(turn[2], turn[2]));
    float facing = max(0.0, normalize(mat3(modelViewMatrix) * turn * across).z);
    float light = ${AMBIENT.toFixed(2)} + ${(1 - AMBIENT).toFixed(2)} * facing;
    vColor = vec4(mix(color * unpacked(look.z), vec3(0.7), look.x) * light, look.y);
    vec3 at = turn * position + vec3(row0.w, row1.w, row2.w);
    gl_Position = projectionMatrix * modelViewMatrix * vec4(at, 1.0);
  }
`;
const FRAGMENT = /* glsl */ `
  varying vec4 vColor;
  void main() { gl_FragColor = vColor; }
`;

/**
 * For copies that read their matrix, colour, grey and alpha from a texture. Lit as everything else by the light at the
 * camera, but at the vertices: small things do not show the difference, software renderers do.
 */
export function slotMaterial(slots: { value: Texture }): ShaderMaterial {
  return new ShaderMaterial({ vertexShader: VERTEX, fragmentShader: FRAGMENT, uniforms: { slots } });
}
