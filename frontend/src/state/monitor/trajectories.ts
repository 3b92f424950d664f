import type { Connection } from "../../connection/connection";
import type { TrajectoryController, TrajectoryJoint } from "../../protocol";
import { Signal } from "../../signal";

const SEND_PERIOD_MS = 100;
/** rad/s or m/s; the velocity of joints whose description has no limit. */
const DEFAULT_VELOCITY = 1;
/** The shortest motion, as rqt_joint_trajectory_controller has it. */
const MIN_SECONDS = 0.1;

/** The joints of a trajectory controller, and the positions to which the user moves them. */
export class TrajectoriesState {
  readonly listChanged = new Signal();
  readonly changed = new Signal();
  controllers: readonly string[] = [];
  name: string | null = null;
  /** The joints of the controller; null until it has answered. */
  controller: TrajectoryController | null = null;
  /** Whether the sliders move the robot. */
  isOn = false;
  /** The share of the joints' maximum velocities, 0 to 1. */
  speed = 0.5;
  readonly targets = new Map<string, number>();
  private isWatching = false;
  private timer: ReturnType<typeof setTimeout> | null = null;

  constructor(private readonly connection: Connection) {
    connection.on("hello", () => {
      this.turn(false);
      if (this.isWatching) this.sendWatch();
    });
    connection.on("trajectory_controllers", ({ controllers }) => {
      this.controllers = controllers;
      this.listChanged.emit();
      if (this.name === null && controllers[0] !== undefined) this.choose(controllers[0]);
    });
    connection.on("trajectory_controller", (controller) => {
      if (controller.controller !== this.name) return;
      this.controller = controller;
      this.changed.emit();
    });
  }

  watch(isWatched: boolean): void {
    if (isWatched === this.isWatching) return;
    this.isWatching = isWatched;
    if (!isWatched) this.turn(false);
    this.sendWatch();
  }

  choose(name: string): void {
    this.turn(false);
    this.name = name;
    this.controller = null;
    this.targets.clear();
    this.changed.emit();
    this.sendWatch();
  }

  /** Starts at the present positions, so that the robot does not move until a slider is moved. */
  turn(isOn: boolean): void {
    this.isOn = isOn;
    this.targets.clear();
    if (this.timer !== null) clearTimeout(this.timer);
    this.timer = null;
    this.changed.emit();
  }

  /** Returns the position of a joint's slider. */
  targetOf({ name, position }: TrajectoryJoint): number {
    return this.targets.get(name) ?? position ?? 0;
  }

  /** Moves a joint to a position; motions are sent at most ten times a second. */
  move(name: string, position: number): void {
    if (!this.isOn || this.controller === null) return;
    if (this.targets.size === 0) for (const joint of this.controller.joints) this.targets.set(joint.name, joint.position ?? 0);
    this.targets.set(name, position);
    this.timer ??= setTimeout(() => this.send(), SEND_PERIOD_MS);
    this.changed.emit();
  }

  private send(): void {
    this.timer = null;
    const { controller } = this;
    if (controller === null || !this.isOn) return;
    const positions = controller.joints.map((joint) => this.targetOf(joint));
    const durations = controller.joints.map((joint) => {
      const distance = Math.abs(this.targetOf(joint) - (joint.position ?? 0));
      return distance / ((joint.velocity ?? DEFAULT_VELOCITY) * this.speed);
    });
    this.connection.send({ type: "move_joints", controller: controller.controller, positions, seconds: Math.max(MIN_SECONDS, ...durations) });
  }

  private sendWatch(): void {
    this.connection.send({ type: "watch_trajectory", wants_list: this.isWatching, controller: this.isWatching ? this.name : null });
  }
}
