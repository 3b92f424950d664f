import { Raycaster, Vector3, type Box3, type Matrix4 } from "three";
import type { ViewState } from "../state/view";
import type { ViewSize } from "../state/views/camera";
import type { Bounds, Vector } from "../state/views/vector";
import { orbitFrom } from "../state/views/orbit";
import { computeViewAround, computeOverview } from "../state/views/surroundings";
import type { ViewValues } from "../state/views/view-controller";
import { PICKABLE_LAYER } from "./layers";

/** What the camera was placed to show without a user: a world without robots, or its robots. */
const WORLD_CONTENT = "world";
const ROBOTS_CONTENT = "robots";
/** The distance of the focal point, m, if the camera of a world's file looks at nothing, and its minimum. */
const DEFAULT_FOCAL_DISTANCE_M = 5;
const MIN_FOCAL_DISTANCE_M = 0.5;

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
  if (!view.awaitsFit(world.hasRobots ? ROBOTS_CONTENT : WORLD_CONTENT)) return;
  const camera = world.readCameraOfFile();
  if (camera) {
    view.proposeValues(computeOrbitValues(world, camera), ROBOTS_CONTENT, true);
    return;
  }
  const boundsByKind = world.computeBoundsByKind();
  const [robots, worldBounds] = [boundsOf(boundsByKind.robots), boundsOf(boundsByKind.world)];
  if (robots) view.proposeValues(computeViewAround(view.values, robots, size, (viewpoint, position) => canSee(world, viewpoint, position)), ROBOTS_CONTENT, true);
  else view.proposeValues(worldBounds ? computeOverview(view.values, worldBounds, size) : {}, WORLD_CONTENT, world.hasRobots);
}

/** Returns the values of an Orbit view that looks like a camera of the world's file, without its roll. */
function computeOrbitValues(world: InitialViewWorld, camera: Matrix4): ViewValues {
  const viewpoint = new Vector3().setFromMatrixPosition(camera);
  const direction = new Vector3(1, 0, 0).transformDirection(camera);
  const focalDistance = world.pick(createRay(viewpoint, direction))?.distance ?? (direction.z < 0 && viewpoint.z > 0 ? -viewpoint.z / direction.z : DEFAULT_FOCAL_DISTANCE_M);
  const focal = viewpoint.clone().addScaledVector(direction, Math.max(focalDistance, MIN_FOCAL_DISTANCE_M));
  return orbitFrom(focal.toArray(), viewpoint.toArray());
}

/** Whether nothing except robots is between a camera and a position. */
function canSee(world: InitialViewWorld, viewpoint: Vector, position: Vector): boolean {
  const start = new Vector3(...viewpoint);
  const direction = new Vector3(...position).sub(start);
  return world.isClear(createRay(start, direction.clone().normalize(), direction.length()));
}

function createRay(viewpoint: Vector3, direction: Vector3, maxDistance = Infinity): Raycaster {
  const ray = new Raycaster(viewpoint, direction, 0, maxDistance);
  ray.layers.enable(PICKABLE_LAYER);
  return ray;
}

/** Returns the corners of a box; null for an empty box. */
export function boundsOf(box: Box3): Bounds | null {
  return box.isEmpty() ? null : { min: box.min.toArray(), max: box.max.toArray() };
}
