import { Raycaster, Vector3, type Box3, type Matrix4 } from "three";
import type { ViewState } from "../state/view";
import type { ViewSize } from "../state/views/camera";
import type { Span, Vector } from "../state/views/vector";
import { aroundFrom } from "../state/views/orbit";
import { around, overview } from "../state/views/surroundings";
import type { ViewValues } from "../state/views/view-controller";
import { TOUCHED } from "./layers";

/** The target of a camera that no user has placed: a world, and then the robots in it. */
const WORLD_SEEN = "world";
const ROBOTS_SEEN = "robots";
/** A camera of a world's file that sees nothing turns about a point this far ahead; no nearer one is taken. m. */
const AHEAD = 5;
const NEAREST = 0.5;

/** The part of a world that the first look uses. */
export interface LookedAt {
  readonly hasRobots: boolean;
  extents(): { robots: Box3; world: Box3 };
  cameraOfFile(): Matrix4 | null;
  isClear(ray: Raycaster): boolean;
  pick(ray: Raycaster): { distance: number } | null;
}

/**
 * Puts a camera that no user has placed where a world's file says; else before its robots, with what is around
 * them; or, until there are some, where all of the world is seen, as when they have fallen out of it.
 */
export function lookFirst(world: LookedAt, view: ViewState, size: ViewSize): void {
  if (!view.awaitsFit(world.hasRobots ? ROBOTS_SEEN : WORLD_SEEN)) return;
  const camera = world.cameraOfFile();
  if (camera) {
    view.propose(throughCamera(world, camera), ROBOTS_SEEN, true);
    return;
  }
  const extents = world.extents();
  const [robots, all] = [spanOf(extents.robots), spanOf(extents.world)];
  if (robots) view.propose(around(view.values, robots, size, (eye, place) => sees(world, eye, place)), ROBOTS_SEEN, true);
  else view.propose(all ? overview(view.values, all, size) : {}, WORLD_SEEN, world.hasRobots);
}

/** The values of an Orbit that looks as a camera of the world's file does, except its roll. */
function throughCamera(world: LookedAt, camera: Matrix4): ViewValues {
  const eye = new Vector3().setFromMatrixPosition(camera);
  const direction = new Vector3(1, 0, 0).transformDirection(camera);
  const hit = world.pick(rayFrom(eye, direction))?.distance ?? (direction.z < 0 && eye.z > 0 ? -eye.z / direction.z : AHEAD);
  const focal = eye.clone().addScaledVector(direction, Math.max(hit, NEAREST));
  return aroundFrom(focal.toArray(), eye.toArray());
}

/** Whether nothing except robots is between a camera and a place. */
function sees(world: LookedAt, eye: Vector, place: Vector): boolean {
  const from = new Vector3(...eye);
  const direction = new Vector3(...place).sub(from);
  return world.isClear(rayFrom(from, direction.clone().normalize(), direction.length()));
}

function rayFrom(eye: Vector3, direction: Vector3, far = Infinity): Raycaster {
  const ray = new Raycaster(eye, direction, 0, far);
  ray.layers.enable(TOUCHED);
  return ray;
}

/** A box by its corners; null for an empty one. */
export function spanOf(box: Box3): Span | null {
  return box.isEmpty() ? null : { min: box.min.toArray(), max: box.max.toArray() };
}
