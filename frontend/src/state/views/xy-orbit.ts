import { intersectGround, castRay, type Camera, type ViewSize } from "./camera";
import { computeFraming } from "./fit";
import { add, distanceBetween, length, scale, subtract, type Bounds, type Vector } from "./vector";
import { lookFromAbove, orbitFrom, OrbitController, readOrbit, type OrbitMotion } from "./orbit";
import { createVectorValues, type Drag, type DragButtons, type PreviousView, type MouseHint, type ViewValues } from "./view-controller";

/**
 * The share of the distance by which the camera is raised, which places the focal point in the lower half of the view.
 */
const RAISE_SHARE = 0.2;
/** The maximum motion of the focal point per step, m: near the horizon a pixel covers many meters. */
const MAX_STEP_M = 1;

/** RViz's XYOrbit: an Orbit view whose focal point moves on the ground, z = 0 of its target. */
export class XYOrbitController extends OrbitController {
  override readonly focalColor: number = 0x00ffff;

  override computeCamera(values: ViewValues): Camera {
    const camera = super.computeCamera(values);
    return { ...camera, position: add(camera.position, camera.up, RAISE_SHARE * readOrbit(values).distance) };
  }

  override applyWheel(values: ViewValues, delta: number): ViewValues {
    return super.applyWheel(values, delta, false);
  }

  override lookAt(values: ViewValues, [x, y]: Vector): ViewValues {
    return orbitFrom([x, y, 0], this.computeCamera(values).position);
  }

  /**
   * Keeps the focal point on the ground, where the line of sight of a camera that shows the whole box intersects it.
   */
  override fit(values: ViewValues, box: Bounds, size: ViewSize): ViewValues {
    const camera = this.computeCamera(values);
    const { center, distance, clip } = computeFraming(camera, values, box, size);
    const position = add(center, camera.back, distance > 0 ? distance : readOrbit(values).distance);
    return { ...this.mimic({ cls: "", values, camera: { ...camera, position } }), ...clip };
  }

  /** Keeps the camera if it is above the ground and looks at it; otherwise starts from the default, as RViz does. */
  override mimic({ cls, camera }: PreviousView): ViewValues {
    if (cls === "rviz_default_plugins/TopDownOrtho") return lookFromAbove(camera.position);
    const centerPoint = intersectGround({ origin: camera.position, direction: scale(camera.back, -1) });
    const bottomPoint = intersectGround({ origin: camera.position, direction: scale(camera.up, -1) });
    if (!centerPoint || !bottomPoint) return this.zero();
    const [centerDistance, bottomDistance] = [distanceBetween(camera.position, centerPoint), distanceBetween(camera.position, bottomPoint)];
    const distance = (centerDistance * bottomDistance) / (RAISE_SHARE * centerDistance + bottomDistance);
    const viewpoint = add(camera.position, camera.up, -RAISE_SHARE * distance);
    const focal = intersectGround({ origin: viewpoint, direction: scale(camera.back, -1) });
    return focal ? orbitFrom(focal, viewpoint) : this.zero();
  }

  override motionOf(drag: DragButtons): OrbitMotion {
    const motion = super.motionOf(drag);
    return motion === "moveZ" ? "zoom" : motion;
  }

  override hintFor(isShiftDown: boolean): MouseHint {
    return isShiftDown ? "groundShift" : "orbit";
  }

  /** Moves the ground with the pointer. */
  protected override pan(values: ViewValues, drag: Drag): ViewValues {
    if (!drag.isLeftDown && !drag.isMiddleDown) return {};
    const camera = this.computeCamera(values);
    const start = intersectGround(castRay(camera, drag.x, drag.y, drag));
    const end = intersectGround(castRay(camera, drag.x + drag.dx, drag.y + drag.dy, drag));
    if (!start || !end) return {};
    const step = subtract(start, end);
    const stepLength = length(step);
    const limitedStep = stepLength > MAX_STEP_M ? scale(step, MAX_STEP_M / stepLength) : step;
    return createVectorValues("Focal Point", add(readOrbit(values).focal, limitedStep));
  }
}

/** RViz's ThirdPersonFollower: an XYOrbit view that moves and rotates with its target, but does not tilt with it. */
export class ThirdPersonFollowerController extends XYOrbitController {
  override readonly followsYaw = true;
}
