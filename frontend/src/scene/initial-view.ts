import { Raycaster, Vector3, type Box3, type Matrix4 } from "three";
import type { ViewState } from "../state/view";
import type { ViewSize } from "../state/views/camera";
import type { Bounds, Vector } from "../state/views/vector";
import { orbitFrom } from "../state/views/orbit";
import { computeViewAround, computeOverview } from "../state/views/surroundings";
import type { ViewValues } from "../state/views/view-controller";
import { PICKABLE } from "./layers";

/** What the camera was placed to show without a user: a world without robots, or its robots. */
const SHOWS_WORLD = "world";
const SHOWS_ROBOTS = "robots";
/** The distance of the focal point, m, if the camera of a world's file looks at nothing, and its minimum. */
const DEFAULT_FOCAL_DISTANCE = 5;
const MIN_FOCAL_DISTANCE = 0.5;

/** The part of a world that the initial view needs. */
export interface InitialViewWorld {
  readonly hasRobots: boolean;
  computeBoundsByKind(): { robots: Box3; world: Box3 };
  readCameraOfFile(): Matrix4 | null;
  isClear(ray: Raycaster): boolean;
  pick(ray: Raycaster): { distance: number } | null;
}

/**
 * Places a camera that no user has placed: where the world's file specifies it; else before the robots, with their
 * surroundings; or, while there are no robots or they have fallen out of the world, where the whole world is visible.
 */
export function setInitialView(world: InitialViewWorld, view: ViewState, size: ViewSize): void {
  if (!view.awaitsFit(world.hasRobots ? SHOWS_ROBOTS : SHOWS_WORLD)) return;
  const camera = world.readCameraOfFile();
  if (camera) {
    view.proposeValues(orbitValuesOf(world, camera), SHOWS_ROBOTS, true);
    return;
  }
  const boundsByKind = world.computeBoundsByKind();
  const [robots, worldBounds] = [boundsOf(boundsByKind.robots), boundsOf(boundsByKind.world)];
  if (robots) view.proposeValues(computeViewAround(view.values, robots, size, (eye, position) => canSee(world, eye, position)), SHOWS_ROBOTS, true);
  else view.proposeValues(worldBounds ? computeOverview(view.values, worldBounds, size) : {}, SHOWS_WORLD, world.hasRobots);
}

/** Returns the values of an Orbit view that looks like a camera of the world's file, without its roll. */
function orbitValuesOf(world: InitialViewWorld, camera: Matrix4): ViewValues {
  const eye = new Vector3().setFromMatrixPosition(camera);
  const direction = new Vector3(1, 0, 0).transformDirection(camera);
  const hit = world.pick(rayFrom(eye, direction))?.distance ?? (direction.z < 0 && eye.z > 0 ? -eye.z / direction.z : DEFAULT_FOCAL_DISTANCE);
  const focal = eye.clone().addScaledVector(direction, Math.max(hit, MIN_FOCAL_DISTANCE));
  return orbitFrom(focal.toArray(), eye.toArray());
}

/** Whether nothing except robots is between a camera and a place. */
function canSee(world: InitialViewWorld, eye: Vector, position: Vector): boolean {
  const start = new Vector3(...eye);
  const direction = new Vector3(...position).sub(start);
  return world.isClear(rayFrom(start, direction.clone().normalize(), direction.length()));
}

function rayFrom(eye: Vector3, direction: Vector3, maxDistance = Infinity): Raycaster {
  const ray = new Raycaster(eye, direction, 0, maxDistance);
  ray.layers.enable(PICKABLE);
  return ray;
}

/** Returns the corners of a box; null for an empty box. */
export function boundsOf(box: Box3): Bounds | null {
  return box.isEmpty() ? null : { min: box.min.toArray(), max: box.max.toArray() };
}
