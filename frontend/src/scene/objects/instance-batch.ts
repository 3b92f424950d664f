import {
  DynamicDrawUsage,
  InstancedBufferAttribute,
  InstancedMesh,
  type BufferGeometry,
  type Matrix4,
  type MeshLambertMaterial,
  type Object3D,
} from "three";
import { FADE_ATTRIBUTE } from "./fading-material";

const SMALLEST_CAPACITY = 16;

/** Many copies of one shape in one draw call, each with its own matrix, grey and alpha. */
export class InstanceBatch {
  private mesh: InstancedMesh;
  private fades: InstancedBufferAttribute;
  private count = 0;
  private seeThrough = false;

  constructor(
    private readonly parent: Object3D,
    private readonly geometry: BufferGeometry,
    private readonly material: MeshLambertMaterial,
  ) {
    [this.mesh, this.fades] = this.allocate(SMALLEST_CAPACITY);
  }

  /** Starts over; `expected` instances will follow. */
  begin(expected: number): void {
    this.count = 0;
    this.seeThrough = false;
    if (expected <= this.mesh.instanceMatrix.count) return;
    this.mesh.removeFromParent();
    this.mesh.dispose();
    [this.mesh, this.fades] = this.allocate(Math.max(expected, this.mesh.instanceMatrix.count * 2));
  }

  add(matrix: Matrix4, grey: number, alpha: number): void {
    this.mesh.setMatrixAt(this.count, matrix);
    this.fades.setXY(this.count, grey, alpha);
    this.seeThrough ||= alpha < 1;
    this.count += 1;
  }

  end(): void {
    this.mesh.count = this.count;
    this.mesh.visible = this.count > 0;
    this.mesh.instanceMatrix.needsUpdate = true;
    this.fades.needsUpdate = true;
    if (this.material.transparent !== this.seeThrough) {
      this.material.transparent = this.seeThrough;
      this.material.depthWrite = !this.seeThrough;
      this.material.needsUpdate = true;
    }
  }

  dispose(): void {
    this.mesh.removeFromParent();
    this.mesh.dispose();
    this.geometry.dispose();
    this.material.dispose();
  }

  private allocate(capacity: number): [InstancedMesh, InstancedBufferAttribute] {
    const mesh = new InstancedMesh(this.geometry, this.material, capacity);
    mesh.instanceMatrix.setUsage(DynamicDrawUsage);
    // The instances are all over the place: a bounding sphere of them costs more than drawing them.
    mesh.frustumCulled = false;
    mesh.matrixAutoUpdate = false;
    mesh.count = 0;
    const fades = new InstancedBufferAttribute(new Float32Array(capacity * 2), 2).setUsage(DynamicDrawUsage);
    this.geometry.setAttribute(FADE_ATTRIBUTE, fades);
    this.parent.add(mesh);
    return [mesh, fades];
  }
}
