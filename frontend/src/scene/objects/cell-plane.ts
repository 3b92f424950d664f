import {
  ClampToEdgeWrapping,
  CustomBlending,
  DataTexture,
  DoubleSide,
  Group,
  Mesh,
  NearestFilter,
  OneMinusSrcAlphaFactor,
  PlaneGeometry,
  RedFormat,
  ShaderMaterial,
} from "three";
import { MIN_OPAQUE_ALPHA } from "../materials";

/** Cells along each side of a part; every graphics library supports textures of this size. */
const CELLS_PER_PART = 4096;

const VERTEX_SHADER = /* glsl */ `
  varying vec2 vUv;
  void main() {
    vUv = uv;
    gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
  }
`;
const FRAGMENT_SHADER = /* glsl */ `
  uniform sampler2D cells;
  uniform sampler2D palette;
  uniform float alpha;
  varying vec2 vUv;
  void main() {
    int value = int(texture2D(cells, vUv).r * 255.0 + 0.5);
    vec4 color = texelFetch(palette, ivec2(value, 0), 0);
    if (color.a == 0.0) discard;
    gl_FragColor = vec4(color.rgb, color.a * alpha);
  }
`;

/** How cells are drawn. */
export interface CellLook {
  /** The colors of the byte values: 256 times red, green, blue and alpha. */
  palette: Uint8Array;
  alpha: number;
  /** Whether some colors of the palette are transparent. */
  isTranslucent: boolean;
  /** Whether the plane is drawn before everything else, which then covers it regardless of depth. */
  isBehind: boolean;
  /** The render order: among coplanar planes, the one with the higher order covers the others. */
  order: number;
}

/** A plane of square cells along x and y from the origin; a palette maps the byte of each cell to a color. */
export class CellPlane {
  readonly root = new Group();
  private parts: Mesh<PlaneGeometry, ShaderMaterial>[] = [];
  private readonly palette = { value: createTexture(new Uint8Array(256 * 4), 256, 1) };
  private look: CellLook | null = null;
  private sizeKey = "";

  /** Sets the cells, row by row; `resolution` is the side of a cell, m. */
  setCells(cells: Uint8Array, width: number, height: number, resolution: number): void {
    const sizeKey = [width, height, resolution].join();
    if (sizeKey !== this.sizeKey) {
      this.clear();
      this.sizeKey = sizeKey;
      for (let y = 0; y < height; y += CELLS_PER_PART) {
        for (let x = 0; x < width; x += CELLS_PER_PART) {
          this.addPart(x, y, Math.min(CELLS_PER_PART, width - x), Math.min(CELLS_PER_PART, height - y), resolution);
        }
      }
      if (this.look) this.setLook(this.look);
    }
    for (const part of this.parts) {
      const { x, y } = part.userData as { x: number; y: number };
      const texture = part.material.uniforms["cells"]?.value as DataTexture;
      copyCells(cells, width, x, y, texture);
      texture.needsUpdate = true;
    }
  }

  setLook(look: CellLook): void {
    this.look = look;
    this.palette.value.image.data?.set(look.palette);
    this.palette.value.needsUpdate = true;
    const isTranslucent = look.alpha < MIN_OPAQUE_ALPHA || look.isTranslucent;
    for (const { material } of this.parts) {
      // A plane drawn behind must precede transparent objects, too: it is blended, but does not count as transparent.
      material.transparent = isTranslucent && !look.isBehind;
      material.blending = CustomBlending;
      material.depthWrite = !isTranslucent && !look.isBehind;
      material.depthTest = !look.isBehind;
      const alpha = material.uniforms["alpha"];
      if (alpha) alpha.value = look.alpha;
      material.needsUpdate = true;
    }
    for (const part of this.parts) part.renderOrder = look.isBehind ? -1000 + look.order : look.order;
  }

  clear(): void {
    for (const part of this.parts) {
      part.removeFromParent();
      part.geometry.dispose();
      (part.material.uniforms["cells"]?.value as DataTexture).dispose();
      part.material.dispose();
    }
    this.parts = [];
    this.sizeKey = "";
  }

  dispose(): void {
    this.clear();
    this.palette.value.dispose();
    this.root.removeFromParent();
  }

  private addPart(x: number, y: number, width: number, height: number, resolution: number): void {
    const [planeWidth, planeHeight] = [width * resolution, height * resolution];
    const geometry = new PlaneGeometry(planeWidth, planeHeight).translate(x * resolution + planeWidth / 2, y * resolution + planeHeight / 2, 0);
    const material = new ShaderMaterial({
      vertexShader: VERTEX_SHADER,
      fragmentShader: FRAGMENT_SHADER,
      uniforms: {
        cells: { value: createTexture(new Uint8Array(width * height), width, height) },
        palette: this.palette,
        alpha: { value: 1 },
      },
      side: DoubleSide,
      blending: CustomBlending,
      blendDst: OneMinusSrcAlphaFactor,
    });
    const mesh = new Mesh(geometry, material);
    mesh.userData = { x, y };
    this.parts.push(mesh);
    this.root.add(mesh);
  }
}

function createTexture(data: Uint8Array, width: number, height: number): DataTexture {
  const texture = new DataTexture(data, width, height);
  if (data.length === width * height) texture.format = RedFormat;
  texture.magFilter = texture.minFilter = NearestFilter;
  texture.wrapS = texture.wrapT = ClampToEdgeWrapping;
  texture.unpackAlignment = 1;
  return texture;
}

/** Copies the cells of a part from the row-by-row cells of the whole. */
function copyCells(cells: Uint8Array, width: number, left: number, bottom: number, texture: DataTexture): void {
  const { data, width: columns, height: rows } = texture.image;
  const target = data as Uint8Array;
  if (columns === width && bottom === 0) {
    target.set(cells.subarray(0, columns * rows));
    return;
  }
  for (let row = 0; row < rows; row++) {
    const start = (bottom + row) * width + left;
    target.set(cells.subarray(start, start + columns), row * columns);
  }
}
