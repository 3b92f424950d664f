import {
  BufferAttribute,
  BufferGeometry,
  DataTexture,
  FloatType,
  Mesh,
  RGBAFormat,
  type Matrix4,
  type Object3D,
  type ShaderMaterial,
} from "three";
import { slotMaterial, SLOTS_PER_ROW, TEXELS_PER_SLOT } from "./slot-material";

const FLOATS_PER_SLOT = TEXELS_PER_SLOT * 4;

/**
 * Many copies of one shape in one draw call, each with its own matrix, grey and alpha.
 *
 * The copies' vertices stand in one buffer and each finds its matrix in a texture. GPU instancing would be shorter, but
 * software renderers take some 50 microseconds for every instance: 500 frames would draw at 6 frames a second.
 */
export class CopyBatch {
  private readonly mesh: Mesh<BufferGeometry, ShaderMaterial>;
  private readonly slots: { value: DataTexture };
  private capacity = 0;
  private count = 0;
  private seeThrough = false;

  constructor(
    parent: Object3D,
    private readonly shape: BufferGeometry,
  ) {
    this.slots = { value: slotTexture(0) };
    this.mesh = new Mesh(new BufferGeometry(), slotMaterial(this.slots));
    this.mesh.visible = false;
    // The copies are all over the place: a bounding sphere of them costs more than drawing them.
    this.mesh.frustumCulled = false;
    this.mesh.matrixAutoUpdate = false;
    parent.add(this.mesh);
  }

  /** Starts over; at most `expected` copies will follow. */
  begin(expected: number): void {
    this.count = 0;
    this.seeThrough = false;
    if (expected <= this.capacity) return;
    this.capacity = Math.ceil((expected * 1.25) / SLOTS_PER_ROW) * SLOTS_PER_ROW;
    this.mesh.geometry.dispose();
    this.mesh.geometry = copies(this.shape, this.capacity);
    this.slots.value.dispose();
    this.slots.value = slotTexture(this.capacity / SLOTS_PER_ROW);
  }

  add(matrix: Matrix4, grey: number, alpha: number): void {
    const data = this.slots.value.image.data as Float32Array;
    const at = this.count * FLOATS_PER_SLOT;
    const m = matrix.elements;
    for (let row = 0; row < 3; row++) {
      for (let column = 0; column < 4; column++) data[at + row * 4 + column] = m[column * 4 + row] ?? 0;
    }
    data[at + 12] = grey;
    data[at + 13] = alpha;
    this.seeThrough ||= alpha < 1;
    this.count += 1;
  }

  end(): void {
    const { material, geometry } = this.mesh;
    this.mesh.visible = this.count > 0;
    geometry.setDrawRange(0, this.count * (this.shape.index?.count ?? 0));
    this.slots.value.needsUpdate = true;
    if (material.transparent === this.seeThrough) return;
    material.transparent = this.seeThrough;
    material.depthWrite = !this.seeThrough;
    material.needsUpdate = true;
  }

  dispose(): void {
    this.mesh.removeFromParent();
    this.mesh.geometry.dispose();
    this.mesh.material.dispose();
    this.slots.value.dispose();
    this.shape.dispose();
  }
}

function slotTexture(rows: number): DataTexture {
  const width = SLOTS_PER_ROW * TEXELS_PER_SLOT;
  const height = Math.max(1, rows);
  return new DataTexture(new Float32Array(width * height * 4), width, height, RGBAFormat, FloatType);
}

/** The shape `count` times over; each vertex knows the number of its copy. */
function copies(shape: BufferGeometry, count: number): BufferGeometry {
  const result = new BufferGeometry();
  const vertices = shape.getAttribute("position").count;
  for (const name of ["position", "normal", "color"]) {
    if (!shape.hasAttribute(name)) continue;
    const { array, itemSize } = shape.getAttribute(name);
    const repeated = new Float32Array(array.length * count);
    for (let copy = 0; copy < count; copy++) repeated.set(array, copy * array.length);
    result.setAttribute(name, new BufferAttribute(repeated, itemSize));
  }
  const slots = new Float32Array(vertices * count);
  for (let copy = 0; copy < count; copy++) slots.fill(copy, copy * vertices, (copy + 1) * vertices);
  result.setAttribute("slot", new BufferAttribute(slots, 1));
  const index = shape.index?.array ?? [];
  const indices = new Uint32Array(index.length * count);
  for (let i = 0; i < indices.length; i++) {
    indices[i] = (index[i % index.length] ?? 0) + Math.floor(i / index.length) * vertices;
  }
  return result.setIndex(new BufferAttribute(indices, 1));
}
