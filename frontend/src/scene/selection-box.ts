import { Matrix4, Mesh, Raycaster, Vector2, Vector3, Vector4, type BufferAttribute, type Camera, type Object3D } from "three";
import { PICKABLE } from "./layers";
import type { SelectionBox } from "./picking";

/** Of a larger geometry, only this number of vertices is tested. */
const MAX_VERTICES = 4000;

/** A rectangle on the screen, in normalized device coordinates (-1 to 1, y up). */
export class ScreenBox implements SelectionBox {
  private readonly toScreen = new Matrix4();
  private readonly corner = new Vector4();
  private readonly point = new Vector3();

  constructor(
    private readonly camera: Camera,
    private readonly low: Vector2,
    private readonly high: Vector2,
    /** Returns whether a point within the rectangle is visible rather than hidden. */
    private readonly isSeen: (x: number, y: number, z: number) => boolean,
  ) {
    this.toScreen.multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse);
  }

  hasPoint(x: number, y: number, z: number): boolean {
    const projectedCorner = this.corner.set(x, y, z, 1).applyMatrix4(this.toScreen);
    if (projectedCorner.w <= 0 || Math.abs(projectedCorner.z) > projectedCorner.w) return false;
    const [u, v] = [projectedCorner.x / projectedCorner.w, projectedCorner.y / projectedCorner.w];
    const isInside = u >= this.low.x && u <= this.high.x && v >= this.low.y && v <= this.high.y;
    return isInside && this.isSeen(u, v, projectedCorner.z / projectedCorner.w);
  }

  hasObject(object: Object3D): boolean {
    const meshes: Mesh[] = [];
    object.traverseVisible((child) => {
      if (child instanceof Mesh) meshes.push(child as Mesh);
    });
    return meshes.some((mesh) => this.hasCorner(mesh)) || this.isHitByRay(meshes);
  }

  private hasCorner(mesh: Mesh): boolean {
    const corners = mesh.geometry.getAttribute("position") as BufferAttribute | undefined;
    if (!corners) return false;
    const step = Math.max(1, Math.floor(corners.count / MAX_VERTICES));
    for (let i = 0; i < corners.count; i += step) {
      const { x, y, z } = this.point.fromBufferAttribute(corners, i).applyMatrix4(mesh.matrixWorld);
      if (this.hasPoint(x, y, z)) return true;
    }
    return false;
  }

  /** Tests rays: a rectangle within a large face contains none of its vertices. */
  private isHitByRay(meshes: Mesh[]): boolean {
    const ray = new Raycaster();
    ray.layers.enable(PICKABLE);
    for (const u of [0.5, 0, 1]) {
      for (const v of [0.5, 0, 1]) {
        const screenPoint = new Vector2(this.low.x + (this.high.x - this.low.x) * u, this.low.y + (this.high.y - this.low.y) * v);
        ray.setFromCamera(screenPoint, this.camera);
        const [hit] = ray.intersectObjects(meshes, false);
        if (hit && this.isSeen(screenPoint.x, screenPoint.y, hit.point.project(this.camera).z)) return true;
      }
    }
    return false;
  }
}
