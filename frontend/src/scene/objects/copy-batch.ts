import {
  Box3,
  BufferAttribute,
  BufferGeometry,
  Frustum,
  Matrix4,
  Mesh,
  Sphere,
  Vector3,
  type Camera,
  type DataTexture,
  type Object3D,
  type Raycaster,
  type ShaderMaterial,
} from "three";
import { polygonOffsetOf } from "../materials";
import { createSlotMaterial, createSlotTexture, TEXELS_PER_SLOT, writeSlot } from "./slot-material";

const FLOATS_PER_SLOT = TEXELS_PER_SLOT * 4;
const WHITE = 0xffffff;
/** Batches with more copies are drawn completely, in the order in which the copies were added. */
const MAX_SORTED_COPIES = 1000;
/** Overlays are drawn after everything but labels. */
const OVERLAY_ORDER = 5;

/** How copies are drawn relative to other objects. */
export interface CopyOptions {
  /** Whether the copies cover everything; for shapes that do not hide parts of themselves. */
  readonly isOverlay?: boolean;
  /** Whether lines and marks in the same plane remain visible. */
  readonly isBehind?: boolean;
  /** Whether the copies have the soft light instead of RViz's; the value may change. */
  readonly isSoft?: { value: boolean };
}

/** The copy that a ray hit, and the point in the fixed frame, m. */
export interface CopyHit {
  copy: number;
  distance: number;
  point: Vector3;
}

/**
 * Many copies of one shape in one draw call, each with its own matrix, color, gray and alpha.
 *
 * Call `begin(capacity)`, then `add` for each copy, then `end`; this replaces the earlier copies. The shape must have
 * an index, normals and colors (`paint` of geometries.ts), which are multiplied by each copy's color.
 *
 * The vertices of all copies are in one buffer, and each finds its matrix in a texture. GPU instancing would be
 * simpler, but software renderers take some 50 microseconds for each instance: 500 frames would be drawn at 6 frames a
 * second. Copies outside the view are omitted for the same reason: their vertices cost as much as visible ones.
 */
export class CopyBatch {
  private readonly mesh: CopyMesh;
  private readonly probe: Mesh;
  private readonly slots: { value: DataTexture };
  private capacity = 0;
  private count = 0;
  private isTranslucent = false;
  /** The contents of the slots of all copies. */
  private allSlots = new Float32Array(0);
  /** The copies in the slots; null for all in their order. */
  private slotOrder: readonly number[] | null = null;
  private isUploaded = false;

  constructor(
    parent: Object3D,
    private readonly shape: BufferGeometry,
    private readonly options: CopyOptions = {},
  ) {
    this.slots = { value: createSlotTexture(0) };
    this.mesh = new CopyMesh(new BufferGeometry(), createSlotMaterial(this.slots, options.isSoft), (box) => this.expandBox(box));
    Object.assign(this.mesh.material, polygonOffsetOf(options.isBehind === true));
    if (options.isOverlay) {
      this.mesh.material.depthTest = this.mesh.material.depthWrite = false;
      this.mesh.material.transparent = true; // opaque objects are drawn first, whatever their order
      this.mesh.renderOrder = OVERLAY_ORDER;
    }
    this.mesh.visible = false;
    this.mesh.onBeforeRender = (_renderer, _scene, camera) => this.arrange(camera);
    // The copies may be anywhere: computing their bounding sphere costs more than drawing them.
    this.mesh.frustumCulled = false;
    this.mesh.matrixAutoUpdate = false;
    this.probe = new Mesh(shape);
    parent.add(this.mesh);
  }

  /** The number of copies drawn now. */
  get size(): number {
    return this.count;
  }

  /** Removes all copies; at most `capacity` will be added. */
  begin(capacity: number): void {
    this.count = 0;
    this.isTranslucent = false;
    this.slotOrder = null;
    if (capacity <= this.capacity) return;
    this.capacity = Math.ceil(capacity * 1.25);
    this.mesh.geometry.dispose();
    this.mesh.geometry = createCopies(this.shape, this.capacity);
    this.slots.value.dispose();
    this.slots.value = createSlotTexture(this.capacity);
    this.allSlots = new Float32Array(this.texels.length);
  }

  /**
   * Adds a copy. `matrix` is in the parent's frame; `gray` is 0 for the copy's own color, 1 for gray; `color` is
   * 0xrrggbb.
   */
  add(matrix: Matrix4, gray = 0, alpha = 1, color = WHITE): void {
    writeSlot(this.allSlots, this.count, matrix, color, gray, alpha);
    this.isTranslucent ||= alpha < 1;
    this.count += 1;
  }

  end(): void {
    const { material, geometry } = this.mesh;
    this.mesh.visible = this.count > 0;
    this.mesh.boundingBox = null;
    geometry.setDrawRange(0, this.count * (this.shape.index?.count ?? 0));
    this.isUploaded = false;
    if (this.options.isOverlay || material.transparent === this.isTranslucent) return;
    material.transparent = this.isTranslucent;
    material.depthWrite = !this.isTranslucent;
    material.needsUpdate = true;
  }

  /** Expands `box` by all copies, in the parent's frame. */
  expandBox(box: Box3): void {
    if (!this.shape.boundingBox) this.shape.computeBoundingBox();
    const shape = this.shape.boundingBox ?? new Box3();
    const matrix = new Matrix4();
    for (let copy = 0; copy < this.count; copy++) box.union(shape.clone().applyMatrix4(this.matrixOf(copy, matrix)));
  }

  /** Returns the nearest copy that a ray hits. */
  pick(ray: Raycaster): CopyHit | null {
    let nearestHit: CopyHit | null = null;
    const { matrixWorld } = this.mesh;
    for (let copy = 0; copy < this.count; copy++) {
      this.matrixOf(copy, this.probe.matrixWorld).premultiply(matrixWorld);
      const [hit] = ray.intersectObject(this.probe, false);
      if (hit && (nearestHit === null || hit.distance < nearestHit.distance)) {
        nearestHit = { copy, distance: hit.distance, point: hit.point };
      }
    }
    return nearestHit;
  }

  dispose(): void {
    this.mesh.removeFromParent();
    this.mesh.geometry.dispose();
    this.mesh.material.dispose();
    this.slots.value.dispose();
    this.shape.dispose();
  }

  /** Fills the slots with the copies in view; transparent ones are sorted from the farthest to the nearest. */
  private arrange(camera: Camera): void {
    const drawingOrder = this.count > MAX_SORTED_COPIES ? null : this.sortVisibleCopies(camera);
    if (this.isUploaded && areEqual(drawingOrder, this.slotOrder)) return;
    const { texels, allSlots } = this;
    if (drawingOrder === null) texels.set(allSlots.subarray(0, this.count * FLOATS_PER_SLOT));
    else {
      drawingOrder.forEach((copy, slot) => {
        texels.set(allSlots.subarray(copy * FLOATS_PER_SLOT, (copy + 1) * FLOATS_PER_SLOT), slot * FLOATS_PER_SLOT);
      });
    }
    this.mesh.geometry.setDrawRange(0, (drawingOrder?.length ?? this.count) * (this.shape.index?.count ?? 0));
    this.slots.value.needsUpdate = true;
    this.slotOrder = drawingOrder;
    this.isUploaded = true;
  }

  /** Returns the copies in a camera's view, in drawing order. */
  private sortVisibleCopies(camera: Camera): number[] {
    if (!this.shape.boundingSphere) this.shape.computeBoundingSphere();
    const shapeSphere = this.shape.boundingSphere ?? new Sphere();
    const view = new Matrix4().multiplyMatrices(camera.matrixWorldInverse, this.mesh.matrixWorld);
    const frustum = new Frustum().setFromProjectionMatrix(camera.projectionMatrix);
    const copies: { copy: number; viewZ: number }[] = [];
    const [matrix, sphere] = [new Matrix4(), new Sphere()];
    for (let copy = 0; copy < this.count; copy++) {
      sphere.copy(shapeSphere).applyMatrix4(this.matrixOf(copy, matrix).premultiply(view));
      if (frustum.intersectsSphere(sphere)) copies.push({ copy, viewZ: sphere.center.z });
    }
    if (this.isTranslucent && !this.options.isOverlay) copies.sort((a, b) => a.viewZ - b.viewZ);
    return copies.map(({ copy }) => copy);
  }

  private get texels(): Float32Array {
    return this.slots.value.image.data as Float32Array;
  }

  private matrixOf(copy: number, matrix: Matrix4): Matrix4 {
    const { allSlots } = this;
    const offset = copy * FLOATS_PER_SLOT;
    const rowAt = (i: number): [number, number, number, number] => [allSlots[i] ?? 0, allSlots[i + 1] ?? 0, allSlots[i + 2] ?? 0, allSlots[i + 3] ?? 0];
    return matrix.set(...rowAt(offset), ...rowAt(offset + 4), ...rowAt(offset + 8), 0, 0, 0, 1);
  }
}

function areEqual(first: readonly number[] | null, second: readonly number[] | null): boolean {
  if (first === null || second === null) return first === second;
  return first.length === second.length && first.every((number, i) => number === second[i]);
}

/** A mesh whose bounds are those of its copies, wherever three.js asks for them. */
class CopyMesh extends Mesh<BufferGeometry, ShaderMaterial> {
  boundingBox: Box3 | null = null;

  constructor(
    geometry: BufferGeometry,
    material: ShaderMaterial,
    private readonly expandBox: (box: Box3) => void,
  ) {
    super(geometry, material);
  }

  computeBoundingBox(): void {
    this.boundingBox = new Box3();
    this.expandBox(this.boundingBox);
  }
}

/** Repeats the shape `count` times; each vertex has the index of its copy. */
function createCopies(shape: BufferGeometry, count: number): BufferGeometry {
  const geometry = new BufferGeometry();
  const vertexCount = shape.getAttribute("position").count;
  for (const name of ["position", "normal", "color"]) {
    if (!shape.hasAttribute(name)) continue;
    const { array, itemSize } = shape.getAttribute(name);
    const repeatedArray = new Float32Array(array.length * count);
    for (let copy = 0; copy < count; copy++) repeatedArray.set(array, copy * array.length);
    geometry.setAttribute(name, new BufferAttribute(repeatedArray, itemSize));
  }
  const slots = new Float32Array(vertexCount * count);
  for (let copy = 0; copy < count; copy++) slots.fill(copy, copy * vertexCount, (copy + 1) * vertexCount);
  geometry.setAttribute("slot", new BufferAttribute(slots, 1));
  const index = shape.index?.array ?? [];
  const indices = new Uint32Array(index.length * count);
  for (let i = 0; i < indices.length; i++) {
    indices[i] = (index[i % index.length] ?? 0) + Math.floor(i / index.length) * vertexCount;
  }
  return geometry.setIndex(new BufferAttribute(indices, 1));
}
