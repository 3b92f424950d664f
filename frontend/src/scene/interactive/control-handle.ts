import {
  Color,
  Group,
  Matrix4,
  Quaternion,
  Vector3,
  type Camera,
  type Intersection,
  type Material,
  type Mesh,
  type Object3D,
  type Raycaster,
} from "three";
import type { InteractiveControl, MarkerShape } from "../../protocol";
import { createMarkerObject, type MarkerObject } from "../markers/marker-object";
import { isSolid, SolidMarkers, createMarkerSurfaces } from "../markers/solid-markers";
import type { MeshLibrary } from "../meshes/mesh-library";
import { setPoseMatrix } from "../pose";

/** The factor and offset by which the colors of a control under the pointer are brightened. */
const BRIGHTNESS_FACTOR = 1.4;
const BRIGHTNESS_OFFSET = 0.15;
/** The color of a control of a marker at a pose that cannot be reached. */
const WRONG_COLOR: readonly number[] = [0.9, 0.05, 0.05];

/** A control of an interactive marker: its markers and its orientation. */
export class ControlHandle {
  /** The group of its markers, in the marker's reference frame. */
  readonly root = new Group();
  /** The angle by which the user has turned the control about its own axis, rad; only `fixed` controls keep it. */
  rotation = 0;
  private readonly solids = new SolidMarkers(this.root);
  private readonly objects: MarkerObject[] = [];
  private readonly ownOrientation: Quaternion;
  private readonly controlOrientation = new Quaternion();
  private isBright = false;
  private isRed = false;

  constructor(
    readonly control: InteractiveControl,
    meshes: MeshLibrary,
    onChanged: () => void,
  ) {
    const [x = 0, y = 0, z = 0, w = 1] = control.orientation;
    this.ownOrientation = new Quaternion(x, y, z, w);
    for (const marker of control.markers) {
      if (isSolid(marker.shape)) continue;
      const object = createMarkerObject(marker, meshes, onChanged);
      const pose = poseOf(marker);
      pose.decompose(object.root.position, object.root.quaternion, new Vector3());
      this.objects.push(object);
      this.root.add(object.root);
    }
    this.arrangeSolids();
  }

  /** Whether the control reacts to the mouse. */
  get isActive(): boolean {
    return this.control.mode !== "none";
  }

  get isSettled(): boolean {
    return this.objects.every((object) => object.isSettled);
  }

  /** The orientation in the reference frame, with the control's axis as x. */
  get orientation(): Quaternion {
    return this.controlOrientation.clone().multiply(this.ownOrientation);
  }

  /** Whether the solid markers are red. */
  get isWrong(): boolean {
    return this.isRed;
  }

  set isWrong(isWrong: boolean) {
    if (isWrong === this.isRed) return;
    this.isRed = isWrong;
    this.arrangeSolids();
  }

  set isHighlighted(isBright: boolean) {
    if (isBright === this.isBright) return;
    this.isBright = isBright;
    this.arrangeSolids();
    for (const { root } of this.objects) root.traverse((object) => brighten(object, isBright));
  }

  /**
   * Moves the control to its marker's pose; `camera` and `reference` (the pose of the marker's frame) orient controls
   * that face the viewer.
   */
  updatePose(position: Vector3, orientation: Quaternion, camera: Camera, reference: Matrix4): void {
    this.root.position.copy(position);
    const mode = this.control.orientation_mode;
    if (mode === "inherit") this.controlOrientation.copy(orientation);
    else if (mode === "fixed") {
      this.controlOrientation.setFromAxisAngle(new Vector3(1, 0, 0).applyQuaternion(this.ownOrientation), this.rotation);
    } else this.controlOrientation.copy(computeFacingOrientation(this.ownOrientation, camera, reference));
    const isIndependent = mode === "view_facing" && this.control.independent_orientation;
    this.root.quaternion.copy(isIndependent ? orientation : this.controlOrientation);
  }

  /** Returns the intersection of a ray with its markers, in the fixed frame. */
  intersect(ray: Raycaster): Intersection | null {
    this.root.updateWorldMatrix(true, true);
    const objects: Object3D[] = this.objects.map((object) => object.root);
    for (const marker of this.control.markers) {
      if (isSolid(marker.shape)) objects.push(...createMarkerSurfaces(marker, poseOf(marker).premultiply(this.root.matrixWorld)));
    }
    return ray.intersectObjects(objects, true)[0] ?? null;
  }

  dispose(): void {
    this.root.removeFromParent();
    this.solids.dispose();
    for (const object of this.objects) object.dispose();
  }

  private arrangeSolids(): void {
    this.solids.begin();
    for (const marker of this.control.markers) {
      if (!isSolid(marker.shape)) continue;
      const [r = 0, g = 0, b = 0] = this.isRed ? WRONG_COLOR : marker.color;
      const alpha = marker.color[3] ?? 1;
      const channels = this.isBright ? [r, g, b].map((channel) => Math.min(1, channel * BRIGHTNESS_FACTOR + BRIGHTNESS_OFFSET)) : [r, g, b];
      this.solids.add({ ...marker, color: [...channels, alpha] }, poseOf(marker));
    }
    this.solids.end();
  }
}

function poseOf({ pose }: MarkerShape): Matrix4 {
  return setPoseMatrix(pose, new Matrix4());
}

function brighten(object: Object3D, isBright: boolean): void {
  const material = (object as Partial<Mesh>).material;
  const materials: readonly Material[] = material ? [material].flat() : [];
  for (const material of materials) {
    if ("color" in material && material.color instanceof Color) material.color.multiplyScalar(isBright ? BRIGHTNESS_FACTOR : 1 / BRIGHTNESS_FACTOR);
  }
}

/**
 * Returns the orientation that turns the control's axis along the line of sight and its z up, as RViz does for controls
 * that face the viewer.
 */
function computeFacingOrientation(ownOrientation: Quaternion, camera: Camera, reference: Matrix4): Quaternion {
  const view = new Quaternion().setFromRotationMatrix(camera.matrixWorld);
  const forward = new Vector3(0, 0, -1).applyQuaternion(view);
  const up = new Vector3(0, 1, 0).applyQuaternion(view);
  const toView = new Quaternion().setFromUnitVectors(new Vector3(1, 0, 0).applyQuaternion(ownOrientation), forward);
  const z = new Vector3(0, 0, 1).applyQuaternion(ownOrientation).applyQuaternion(toView);
  const toUpright = new Quaternion().setFromUnitVectors(z.projectOnPlane(forward).normalize(), up);
  const frame = new Quaternion().setFromRotationMatrix(reference);
  return frame.invert().multiply(toUpright.multiply(toView));
}
