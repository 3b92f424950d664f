import {
  BufferAttribute,
  BufferGeometry,
  DynamicDrawUsage,
  Frustum,
  Matrix4,
  Mesh,
  Sphere,
  Vector3,
  type Camera,
  type DataTexture,
  type Object3D,
} from "three";
import { PICKABLE_LAYER } from "../layers";
import type { LodMesh } from "../meshes/lod-mesh";
import { createLitSlotMaterial, createSlotTexture, writeSlot } from "../objects/slot-material";

/** The maximum error that users do not notice in a moving frame, in its pixels. */
const MAX_ERROR_PX = 1;

/** The frame during motion for which LOD meshes are drawn. */
export interface MovingView {
  readonly camera: Camera;
  /** The height in pixels of the frame, which may be larger than those of the screen. */
  readonly height: number;
}

/** A piece of a mesh with its matrix and its color 0xrrggbb. */
export interface MovingPiece {
  readonly lodMesh: LodMesh;
  readonly matrix: Matrix4;
  readonly color: number;
}

/**
 * Draws all meshes of a moving robot in one draw call, each with the fewest triangles that look the same. Software renderers
 * take some 0.3 microseconds for each triangle, and 100 for each draw call.
 */
export class MovingMeshes {
  private mesh: Mesh<BufferGeometry, ReturnType<typeof createLitSlotMaterial>> | null = null;
  private readonly slots: { value: DataTexture } = { value: createSlotTexture(0) };
  /** In the buffers: the LOD meshes of the pieces, the index of the first vertex of each, and the levels drawn. */
  private bufferedMeshes: readonly LodMesh[] = [];
  private firstVertices: number[] = [];
  private levels: readonly (number | null)[] = [];
  private hiddenMeshes: Mesh[] = [];
  private readonly softness = { value: false };

  constructor(private readonly parent: Object3D) {}

  /** Whether the meshes have the soft light instead of RViz's. */
  set isSoft(isSoft: boolean) {
    this.softness.value = isSoft;
  }

  /** The number of pieces and triangles drawn last. */
  get drawnCounts(): { pieces: number; triangles: number } {
    const pieces = this.levels.filter((level) => level !== null).length;
    return { pieces, triangles: (this.mesh?.geometry.drawRange.count ?? 0) / 3 };
  }

  /** Draws pieces instead of meshes, until `restoreMeshes`. */
  replaceMeshes(pieces: readonly MovingPiece[], meshes: readonly Mesh[], view: MovingView): void {
    const mesh = this.fillBuffers(pieces);
    pieces.forEach(({ matrix, color }, slot) => writeSlot(this.texels, slot, matrix, color));
    this.slots.value.needsUpdate = true;
    this.updateIndex(mesh.geometry, pieces, view);
    for (const mesh of meshes) {
      mesh.layers.disable(0);
      mesh.layers.enable(PICKABLE_LAYER);
    }
    this.hiddenMeshes = [...meshes];
    this.parent.add(mesh);
  }

  restoreMeshes(): void {
    this.mesh?.removeFromParent();
    for (const mesh of this.hiddenMeshes) mesh.layers.enable(0);
    this.hiddenMeshes = [];
  }

  dispose(): void {
    this.restoreMeshes();
    this.mesh?.geometry.dispose();
    this.mesh?.material.dispose();
    this.slots.value.dispose();
  }

  private get texels(): Float32Array {
    return this.slots.value.image.data as Float32Array;
  }

  /** Fills one buffer with the vertices of all pieces; each vertex has the index of its piece. */
  private fillBuffers(pieces: readonly MovingPiece[]): NonNullable<MovingMeshes["mesh"]> {
    const { bufferedMeshes } = this;
    if (this.mesh && bufferedMeshes.length === pieces.length && pieces.every(({ lodMesh }, i) => lodMesh === bufferedMeshes[i])) return this.mesh;
    this.bufferedMeshes = pieces.map(({ lodMesh }) => lodMesh);
    this.firstVertices = [];
    this.levels = [];
    let vertexCount = 0;
    for (const { positions } of this.bufferedMeshes) {
      this.firstVertices.push(vertexCount);
      vertexCount += positions.length / 3;
    }
    const [vertexPositions, normals, vertexSlots] = [new Float32Array(3 * vertexCount), new Float32Array(3 * vertexCount), new Float32Array(vertexCount)];
    this.bufferedMeshes.forEach((lodMesh, i) => {
      const firstVertex = this.firstVertices[i] ?? 0;
      vertexPositions.set(lodMesh.positions, 3 * firstVertex);
      normals.set(lodMesh.normals, 3 * firstVertex);
      vertexSlots.fill(i, firstVertex, firstVertex + lodMesh.positions.length / 3);
    });
    const indexCount = this.bufferedMeshes.reduce((sum, { levels }) => sum + (levels[0]?.index.length ?? 0), 0);
    const geometry = new BufferGeometry()
      .setAttribute("position", new BufferAttribute(vertexPositions, 3))
      .setAttribute("normal", new BufferAttribute(normals, 3))
      .setAttribute("slot", new BufferAttribute(vertexSlots, 1))
      .setIndex(new BufferAttribute(new Uint32Array(indexCount), 1).setUsage(DynamicDrawUsage));
    this.slots.value.dispose();
    this.slots.value = createSlotTexture(pieces.length);
    this.mesh?.geometry.dispose();
    this.mesh ??= new Mesh(geometry, createLitSlotMaterial(this.slots, this.softness));
    this.mesh.geometry = geometry;
    this.mesh.frustumCulled = this.mesh.matrixAutoUpdate = false;
    return this.mesh;
  }

  /** Fills the index with the visible pieces, each at the coarsest level whose error is not noticed. */
  private updateIndex(geometry: BufferGeometry, pieces: readonly MovingPiece[], view: MovingView): void {
    const levels = chooseLevels(pieces, view);
    if (levels.length === this.levels.length && levels.every((level, i) => level === this.levels[i])) return;
    this.levels = levels;
    const { index } = geometry;
    if (!index) return;
    let count = 0;
    pieces.forEach(({ lodMesh }, i) => {
      const indices = lodMesh.levels[levels[i] ?? -1]?.index ?? [];
      const firstVertex = this.firstVertices[i] ?? 0;
      for (const vertex of indices) index.array[count++] = firstVertex + vertex;
    });
    geometry.setDrawRange(0, count);
    index.clearUpdateRanges();
    index.addUpdateRange(0, count);
    index.needsUpdate = true;
  }
}

/**
 * Returns for each piece the index of the coarsest level that looks like the finest; null for pieces outside the view.
 */
export function chooseLevels(pieces: readonly MovingPiece[], { camera, height }: MovingView): (number | null)[] {
  const { elements } = camera.projectionMatrix;
  const isPerspective = elements[11] !== 0;
  const frustum = new Frustum().setFromProjectionMatrix(camera.projectionMatrix);
  const [viewMatrix, center, boundingSphere] = [new Matrix4(), new Vector3(), new Sphere()];
  return pieces.map(({ lodMesh: { boundingSphere: [x, y, z, radius], levels }, matrix }) => {
    const scale = matrix.getMaxScaleOnAxis();
    viewMatrix.multiplyMatrices(camera.matrixWorldInverse, matrix);
    boundingSphere.set(center.set(x, y, z).applyMatrix4(viewMatrix), radius * scale);
    if (!frustum.intersectsSphere(boundingSphere)) return null;
    const depth = isPerspective ? -center.z - boundingSphere.radius : 1;
    // m of the piece in a pixel, where it is nearest
    const invisibleError = depth <= 0 ? 0 : (MAX_ERROR_PX * depth) / (elements[5] * 0.5 * height * scale);
    return levels.findLastIndex(({ error }) => error <= invisibleError);
  });
}
