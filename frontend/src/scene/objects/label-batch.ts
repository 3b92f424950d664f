import {
  DynamicDrawUsage,
  Float32BufferAttribute,
  InstancedBufferGeometry,
  InstancedInterleavedBuffer,
  InterleavedBufferAttribute,
  Mesh,
  ShaderMaterial,
  type Vector3,
} from "three";
import { GlyphAtlas } from "./glyph-atlas";

const VERTEX = /* glsl */ `
  attribute vec3 anchor;
  attribute vec4 box;
  attribute vec4 uvBox;
  attribute vec2 fade;
  varying vec2 vUv;
  varying vec2 vFade;
  void main() {
    vUv = uvBox.xy + position.xy * uvBox.zw;
    vFade = fade;
    vec4 at = modelViewMatrix * vec4(anchor, 1.0);
    at.xy += box.xy + position.xy * box.zw;
    gl_Position = projectionMatrix * at;
  }
`;
const FRAGMENT = /* glsl */ `
  uniform sampler2D map;
  varying vec2 vUv;
  varying vec2 vFade;
  void main() {
    vec4 ink = texture2D(map, vUv);
    gl_FragColor = vec4(ink.rgb * mix(1.0, 0.7, vFade.x), ink.a) * vFade.y;
  }
`;
/** anchor 3, box 4, uv 4, fade 2 */
const STRIDE = 13;

/** Any number of short texts facing the camera, sized in metres, in one draw call and drawn over everything. */
export class LabelBatch {
  readonly root: Mesh<InstancedBufferGeometry, ShaderMaterial>;
  private readonly atlas = new GlyphAtlas();
  private data = new Float32Array(0);
  private buffer: InstancedInterleavedBuffer | null = null;
  private glyphs = 0;

  constructor() {
    const material = new ShaderMaterial({
      vertexShader: VERTEX,
      fragmentShader: FRAGMENT,
      uniforms: { map: { value: this.atlas.texture } },
      transparent: true,
      premultipliedAlpha: true,
      depthTest: false,
      depthWrite: false,
    });
    this.root = new Mesh(new InstancedBufferGeometry(), material);
    this.root.visible = false;
    this.root.frustumCulled = false;
    this.root.renderOrder = 10;
  }

  /** Starts over; texts of `characters` in all will follow. */
  begin(characters: number): void {
    this.glyphs = 0;
    if (this.data.length < characters * STRIDE) this.allocate(Math.max(64, characters * 2));
  }

  /** Adds a text centred below `anchor`; `height` is that of a line, m. */
  add(text: string, anchor: Vector3, height: number, grey: number, alpha: number): void {
    const glyphs = [...text].map((character) => this.atlas.glyph(character));
    const width = glyphs.reduce((sum, glyph) => sum + glyph.advance, 0);
    let pen = -width / 2;
    for (const glyph of glyphs) {
      const x = pen - (glyph.width - glyph.advance) / 2;
      const row = [anchor.x, anchor.y, anchor.z, x * height, -height, glyph.width * height, height];
      this.data.set([...row, ...glyph.uv, grey, alpha], this.glyphs * STRIDE);
      this.glyphs += 1;
      pen += glyph.advance;
    }
  }

  end(): void {
    this.root.geometry.instanceCount = this.glyphs;
    this.root.visible = this.glyphs > 0;
    if (this.buffer) this.buffer.needsUpdate = true;
  }

  dispose(): void {
    this.root.removeFromParent();
    this.root.geometry.dispose();
    this.root.material.dispose();
    this.atlas.texture.dispose();
  }

  private allocate(capacity: number): void {
    this.data = new Float32Array(capacity * STRIDE);
    const buffer = new InstancedInterleavedBuffer(this.data, STRIDE).setUsage(DynamicDrawUsage);
    const geometry = new InstancedBufferGeometry();
    geometry.setAttribute("position", new Float32BufferAttribute([0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0], 3));
    geometry.setIndex([0, 1, 2, 0, 2, 3]);
    geometry.setAttribute("anchor", new InterleavedBufferAttribute(buffer, 3, 0));
    geometry.setAttribute("box", new InterleavedBufferAttribute(buffer, 4, 3));
    geometry.setAttribute("uvBox", new InterleavedBufferAttribute(buffer, 4, 7));
    geometry.setAttribute("fade", new InterleavedBufferAttribute(buffer, 2, 11));
    // A geometry remembers the first number of instances it was drawn with: more of them need a new one.
    this.root.geometry.dispose();
    this.root.geometry = geometry;
    this.buffer = buffer;
  }
}
