import type { OrbitView } from "../protocol.gen";
import type { FrameStore } from "./frames";
import { clampDistance, clampPitch, wrapYaw, ZERO_ORBIT, type Orbit, type Vector } from "./orbit";
import { Signal } from "./signal";

export const FIXED_FRAME = "<Fixed Frame>";
const SMALLEST_NEAR_CLIP = 0.001;

/** The current view. The server proposes one at the start; from then on the page owns it. */
export class ViewState {
  readonly changed = new Signal();
  private view: OrbitView = {
    cls: "rviz_default_plugins/Orbit",
    name: "Current View",
    near_clip_distance: 0.01,
    invert_z_axis: false,
    target_frame: FIXED_FRAME,
    distance: ZERO_ORBIT.distance,
    yaw: ZERO_ORBIT.yaw,
    pitch: ZERO_ORBIT.pitch,
    focal_point: [...ZERO_ORBIT.focal],
    focal_shape_size: 0.05,
    focal_shape_fixed_size: true,
  };
  private configured: OrbitView | null = null;

  constructor(private readonly frames: FrameStore) {}

  get current(): Readonly<OrbitView> {
    return this.view;
  }

  get orbit(): Orbit {
    const { distance, yaw, pitch, focal_point, invert_z_axis } = this.view;
    const [x = 0, y = 0, z = 0] = focal_point;
    return { distance, yaw, pitch, focal: [x, y, z], invertZ: invert_z_axis };
  }

  /** The view of the configuration file: taken once; a reconnect does not move the user's camera. */
  configure(view: OrbitView): void {
    const first = this.configured === null;
    this.configured = view;
    if (first) this.update(view);
  }

  setOrbit(orbit: Orbit): void {
    this.update({ ...orbit, focal_point: [...orbit.focal], invert_z_axis: orbit.invertZ });
  }

  /** Takes what is given and legal of a view. */
  update(part: Partial<OrbitView>): void {
    const next = { ...this.view, ...pick(part, Object.keys(this.view) as (keyof OrbitView)[]) };
    next.distance = clampDistance(next.distance);
    next.pitch = clampPitch(next.pitch);
    next.yaw = wrapYaw(next.yaw);
    next.near_clip_distance = Math.max(SMALLEST_NEAR_CLIP, next.near_clip_distance);
    this.view = next;
    this.changed.emit();
  }

  /** Follows another frame without moving the eye, as RViz does. */
  setTargetFrame(name: string): void {
    const before = this.targetPosition();
    this.view = { ...this.view, target_frame: name };
    const after = this.targetPosition();
    const [x = 0, y = 0, z = 0] = this.view.focal_point;
    this.update({ focal_point: [x + before[0] - after[0], y + before[1] - after[1], z + before[2] - after[2]] });
  }

  /** Position of the target frame in the fixed frame, m; the origin while it is unknown. */
  targetPosition(): Vector {
    const row = this.frames.row(this.view.target_frame);
    if (!this.frames.has(row)) return [0, 0, 0];
    const { poses } = this.frames;
    return [poses[row * 7] ?? 0, poses[row * 7 + 1] ?? 0, poses[row * 7 + 2] ?? 0];
  }

  /** RViz's Zero button. */
  zero(): void {
    this.setOrbit({ ...ZERO_ORBIT, invertZ: this.view.invert_z_axis });
  }

  /** Back to the view of the configuration file. */
  reset(): void {
    if (this.configured) this.update(this.configured);
    else this.zero();
  }
}

function pick<T extends object>(from: Partial<T>, keys: readonly (keyof T)[]): Partial<T> {
  const result: Partial<T> = {};
  for (const key of keys) if (from[key] !== undefined) result[key] = from[key];
  return result;
}
