import {
  BufferAttribute,
  BufferGeometry,
  DynamicDrawUsage,
  InterleavedBuffer,
  InterleavedBufferAttribute,
  Mesh,
  ShaderMaterial,
  type Vector3,
} from "three";
import { GlyphAtlas } from "./glyph-atlas";

const VERTEX_SHADER = /* glsl */ `
  attribute vec2 corner;
  attribute vec2 fade;
  varying vec2 vUv;
  varying vec2 vFade;
  void main() {
    vUv = uv;
    vFade = fade;
    vec4 viewPosition = modelViewMatrix * vec4(position, 1.0);
    viewPosition.xy += corner;
    gl_Position = projectionMatrix * viewPosition;
  }
`;
const FRAGMENT_SHADER = /* glsl */ `
  uniform sampler2D map;
  varying vec2 vUv;
  varying vec2 vFade;
  void main() {
    vec4 glyphColor = texture2D(map, vUv);
    gl_FragColor = vec4(glyphColor.rgb * mix(1.0, 0.7, vFade.x), glyphColor.a) * vFade.y;
  }
`;
/** Floats per vertex: anchor 3, corner 2, uv 2, fade 2. */
const FLOATS_PER_VERTEX = 9;
const FLOATS_PER_GLYPH = FLOATS_PER_VERTEX * 4;
/** The corners of a glyph, in units of its width and height. */
const CORNERS = [
  [0, 0],
  [1, 0],
  [1, 1],
  [0, 1],
] as const;

/** Any number of short texts that face the camera, sized in meters, in one draw call and drawn over everything. */
export class LabelBatch {
  readonly root: Mesh<BufferGeometry, ShaderMaterial>;
  private readonly atlas = new GlyphAtlas();
  /**
   * For each text and each glyph: x from the center, width, and u, v, width, height in the atlas, for a line height of
   * 1.
   */
  private readonly layouts = new Map<string, Float32Array>();
  private vertexData = new Float32Array(0);
  private buffer: InterleavedBuffer | null = null;
  private glyphs = 0;

  constructor() {
    const material = new ShaderMaterial({
      vertexShader: VERTEX_SHADER,
      fragmentShader: FRAGMENT_SHADER,
      uniforms: { map: { value: this.atlas.texture } },
      transparent: true,
      premultipliedAlpha: true,
      depthTest: false,
      depthWrite: false,
    });
    this.root = new Mesh(new BufferGeometry(), material);
    this.root.visible = false;
    this.root.frustumCulled = false;
    this.root.renderOrder = 10;
  }

  /** Removes all texts; texts with this many characters in total will be added. */
  begin(characterCount: number): void {
    this.glyphs = 0;
    if (this.vertexData.length < characterCount * FLOATS_PER_GLYPH) this.allocate(Math.max(64, Math.ceil(characterCount * 1.5)));
  }

  /** Adds a text centered below `anchor`; `height` is the height of a line, m. */
  add(text: string, anchor: Vector3, height: number, gray: number, alpha: number): void {
    const { vertexData } = this;
    const layout = this.layout(text);
    let offset = this.glyphs * FLOATS_PER_GLYPH;
    for (let i = 0; i < layout.length; i += 6) {
      const [x = 0, width = 0, u = 0, v = 0, uWidth = 0, vHeight = 0] = layout.subarray(i, i + 6);
      for (const [right, top] of CORNERS) {
        vertexData[offset] = anchor.x;
        vertexData[offset + 1] = anchor.y;
        vertexData[offset + 2] = anchor.z;
        vertexData[offset + 3] = (x + right * width) * height;
        vertexData[offset + 4] = (top - 1) * height;
        vertexData[offset + 5] = u + right * uWidth;
        vertexData[offset + 6] = v + top * vHeight;
        vertexData[offset + 7] = gray;
        vertexData[offset + 8] = alpha;
        offset += FLOATS_PER_VERTEX;
      }
      this.glyphs += 1;
    }
  }

  end(): void {
    this.root.geometry.setDrawRange(0, this.glyphs * 6);
    this.root.visible = this.glyphs > 0;
    if (!this.buffer) return;
    this.buffer.clearUpdateRanges();
    this.buffer.addUpdateRange(0, this.glyphs * FLOATS_PER_GLYPH);
    this.buffer.needsUpdate = true;
  }

  dispose(): void {
    this.root.removeFromParent();
    this.root.geometry.dispose();
    this.root.material.dispose();
    this.atlas.texture.dispose();
  }

  private layout(text: string): Float32Array {
    let layout = this.layouts.get(text);
    if (!layout) {
      const glyphs = Array.from(text, (character) => this.atlas.glyphOf(character));
      let pen = -glyphs.reduce((sum, glyph) => sum + glyph.advance, 0) / 2;
      layout = new Float32Array(
        glyphs.flatMap((glyph) => {
          const x = pen - (glyph.width - glyph.advance) / 2;
          pen += glyph.advance;
          return [x, glyph.width, ...glyph.uv];
        }),
      );
      this.layouts.set(text, layout);
    }
    return layout;
  }

  private allocate(glyphCount: number): void {
    this.vertexData = new Float32Array(glyphCount * FLOATS_PER_GLYPH);
    const buffer = new InterleavedBuffer(this.vertexData, FLOATS_PER_VERTEX).setUsage(DynamicDrawUsage);
    const indices = new Uint32Array(glyphCount * 6);
    for (let i = 0; i < glyphCount; i++) indices.set([0, 1, 2, 0, 2, 3].map((corner) => i * 4 + corner), i * 6);
    const geometry = new BufferGeometry().setIndex(new BufferAttribute(indices, 1));
    geometry.setAttribute("position", new InterleavedBufferAttribute(buffer, 3, 0));
    geometry.setAttribute("corner", new InterleavedBufferAttribute(buffer, 2, 3));
    geometry.setAttribute("uv", new InterleavedBufferAttribute(buffer, 2, 5));
    geometry.setAttribute("fade", new InterleavedBufferAttribute(buffer, 2, 7));
    this.root.geometry.dispose();
    this.root.geometry = geometry;
    this.buffer = buffer;
  }
}
