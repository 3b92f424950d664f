import { Matrix4, Mesh, Raycaster, Vector2, Vector3, Vector4, type BufferAttribute, type Camera, type Object3D } from "three";
import { PICKABLE_LAYER } from "./layers";
import type { SelectionBox } from "./picking";

/** Of a larger geometry, only this number of vertices is tested. */
const MAX_TESTED_VERTICES = 4000;

/** A rectangle on the screen, in normalized device coordinates (-1 to 1, y up). */
export class ScreenBox implements SelectionBox {
  private readonly toScreen = new Matrix4();
  private readonly clipPosition = new Vector4();
  private readonly point = new Vector3();

  constructor(
    private readonly camera: Camera,
    private readonly min: Vector2,
    private readonly max: Vector2,
    /** Returns whether a point within the rectangle is visible rather than hidden. */
    private readonly isVisible: (x: number, y: number, z: number) => boolean,
  ) {
    this.toScreen.multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse);
  }

  hasPoint(x: number, y: number, z: number): boolean {
    const projected = this.clipPosition.set(x, y, z, 1).applyMatrix4(this.toScreen);
    if (projected.w <= 0 || Math.abs(projected.z) > projected.w) return false;
    const [u, v] = [projected.x / projected.w, projected.y / projected.w];
    const isInside = u >= this.min.x && u <= this.max.x && v >= this.min.y && v <= this.max.y;
    return isInside && this.isVisible(u, v, projected.z / projected.w);
  }

  hasObject(object: Object3D): boolean {
    const meshes: Mesh[] = [];
    object.traverseVisible((child) => {
      if (child instanceof Mesh) meshes.push(child as Mesh);
    });
    return meshes.some((mesh) => this.hasVertex(mesh)) || this.isHitByRay(meshes);
  }

  private hasVertex(mesh: Mesh): boolean {
    const positions = mesh.geometry.getAttribute("position") as BufferAttribute | undefined;
    if (!positions) return false;
    const step = Math.max(1, Math.floor(positions.count / MAX_TESTED_VERTICES));
    for (let i = 0; i < positions.count; i += step) {
      const { x, y, z } = this.point.fromBufferAttribute(positions, i).applyMatrix4(mesh.matrixWorld);
      if (this.hasPoint(x, y, z)) return true;
    }
    return false;
  }

  /** Tests rays: a rectangle within a large face contains none of its vertices. */
  private isHitByRay(meshes: Mesh[]): boolean {
    const ray = new Raycaster();
    ray.layers.enable(PICKABLE_LAYER);
    for (const u of [0.5, 0, 1]) {
      for (const v of [0.5, 0, 1]) {
        const screenPoint = new Vector2(this.min.x + (this.max.x - this.min.x) * u, this.min.y + (this.max.y - this.min.y) * v);
        ray.setFromCamera(screenPoint, this.camera);
        const [hit] = ray.intersectObjects(meshes, false);
        if (hit && this.isVisible(screenPoint.x, screenPoint.y, hit.point.project(this.camera).z)) return true;
      }
    }
    return false;
  }
}
