import { DataTexture, DoubleSide, FloatType, RGBAFormat, ShaderMaterial, type Matrix4, type Texture } from "three";
import { SURFACE_LIGHT } from "../light";

/** Texels of a slot: three rows of the matrix, then one with gray, alpha and color. */
export const TEXELS_PER_SLOT = 4;
const SLOTS_PER_ROW = 64;

const SLOT_FUNCTIONS = /* glsl */ `
  attribute float slot;
  uniform highp sampler2D slots;
  vec4 readTexel(int part) {
    int index = int(slot + 0.5);
    return texelFetch(slots, ivec2((index % ${SLOTS_PER_ROW}) * ${TEXELS_PER_SLOT} + part, index / ${SLOTS_PER_ROW}), 0);
  }
  vec3 unpackColor(float rgb) {
    return vec3((uvec3(rgb) >> uvec3(16u, 8u, 0u)) & 255u) * (1.0 / 255.0);
  }
`;
const LIGHT_FUNCTIONS = /* glsl */ `
  uniform bool isSoft;
  ${SURFACE_LIGHT}
  vec3 applyLight(vec3 color, vec3 normal) { return isSoft ? applySoftLight(color, normal) : applyCameraLight(color, normal.z); }
`;
const VERTEX_SHADER = /* glsl */ `
  ${SLOT_FUNCTIONS}
  ${LIGHT_FUNCTIONS}
  attribute vec3 color;
  varying vec4 vColor;
  void main() {
    vec4 row0 = readTexel(0), row1 = readTexel(1), row2 = readTexel(2), look = readTexel(3);
    mat3 linearPart = transpose(mat3(row0.xyz, row1.xyz, row2.xyz));
    vec3 unscaledNormal = normal / vec3(dot(linearPart[0], linearPart[0]), dot(linearPart[1], linearPart[1]), dot(linearPart[2], linearPart[2]));
    vec3 viewNormal = normalize(mat3(modelViewMatrix) * linearPart * unscaledNormal);
    vColor = vec4(applyLight(mix(color * unpackColor(look.z), vec3(0.7), look.x), viewNormal), look.y);
    vec3 objectPosition = linearPart * position + vec3(row0.w, row1.w, row2.w);
    gl_Position = projectionMatrix * modelViewMatrix * vec4(objectPosition, 1.0);
  }
`;
const FRAGMENT_SHADER = /* glsl */ `
  varying vec4 vColor;
  void main() { gl_FragColor = vColor; }
`;

// Both sides are lit, as in three.js: a normal belongs to the side from which the triangle's corners run
// counterclockwise.
const LIT_VERTEX_SHADER = /* glsl */ `
  ${SLOT_FUNCTIONS}
  flat varying vec3 vColor;
  varying vec3 vNormal;
  void main() {
    vec4 row0 = readTexel(0), row1 = readTexel(1), row2 = readTexel(2);
    mat3 linearPart = transpose(mat3(row0.xyz, row1.xyz, row2.xyz));
    vec3 unscaledNormal = normal / vec3(dot(linearPart[0], linearPart[0]), dot(linearPart[1], linearPart[1]), dot(linearPart[2], linearPart[2]));
    vNormal = normalize(mat3(modelViewMatrix) * linearPart * unscaledNormal) * sign(determinant(linearPart));
    vColor = unpackColor(readTexel(3).z);
    vec3 objectPosition = linearPart * position + vec3(row0.w, row1.w, row2.w);
    gl_Position = projectionMatrix * modelViewMatrix * vec4(objectPosition, 1.0);
  }
`;
const LIT_FRAGMENT_SHADER = /* glsl */ `
  ${LIGHT_FUNCTIONS}
  flat varying vec3 vColor;
  varying vec3 vNormal;
  void main() {
    gl_FragColor = vec4(applyLight(vColor, normalize(vNormal) * (gl_FrontFacing ? 1.0 : -1.0)), 1.0);
  }
`;

/** Returns a texture with this number of slots, 64 in a row. */
export function createSlotTexture(slots: number): DataTexture {
  const width = SLOTS_PER_ROW * TEXELS_PER_SLOT;
  const height = Math.max(1, Math.ceil(slots / SLOTS_PER_ROW));
  return new DataTexture(new Float32Array(width * height * 4), width, height, RGBAFormat, FloatType);
}

/** Writes an affine matrix and a color 0xrrggbb into a slot; `data` is that of a texture, or has the same layout. */
export function writeSlot(data: Float32Array, slot: number, matrix: Matrix4, color: number, gray = 0, alpha = 1): void {
  const offset = slot * TEXELS_PER_SLOT * 4;
  const m = matrix.elements;
  for (let row = 0; row < 3; row++) {
    for (let column = 0; column < 4; column++) data[offset + row * 4 + column] = m[column * 4 + row] ?? 0;
  }
  data[offset + 12] = gray;
  data[offset + 13] = alpha;
  data[offset + 14] = color;
}

/**
 * Returns a material for copies that read their matrix, color, gray and alpha from a texture. Light is computed like
 * that of other objects, but at the vertices: the difference does not show on small objects, and software renderers are
 * faster.
 */
export function createSlotMaterial(slots: { value: Texture }, isSoft = { value: false }): ShaderMaterial {
  return new ShaderMaterial({ vertexShader: VERTEX_SHADER, fragmentShader: FRAGMENT_SHADER, uniforms: { slots, isSoft } });
}

/**
 * Returns a material for opaque, double-sided surfaces that are lit at each pixel, as three.js does for the light at
 * the camera.
 */
export function createLitSlotMaterial(slots: { value: Texture }, isSoft: { value: boolean }): ShaderMaterial {
  return new ShaderMaterial({ vertexShader: LIT_VERTEX_SHADER, fragmentShader: LIT_FRAGMENT_SHADER, uniforms: { slots, isSoft }, side: DoubleSide });
}
