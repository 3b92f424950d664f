import type { Connection } from "../../connection/connection";
import type { TeleopState as Aim, TwistKind } from "../../protocol";
import { Signal } from "../../signal";
import { isStill, NO_MOTION, sumMotions, type Motion } from "./teleop-keys";

export interface TeleopSettings {
  topic: string;
  kind: TwistKind;
  frameId: string;
  /** The maximum linear velocity along each axis, m/s. */
  linear: number;
  /** The maximum angular velocity, rad/s. */
  angular: number;
  /** The number of velocity messages per second while driving, 10 to 20. */
  rate: number;
  gamepad: boolean;
}

/** A source of motion; the motions of all sources are added. */
export type MotionSource = "keys" | "pad" | "gamepad";

const STORAGE_KEY = "linkwright.teleop.1";
const DEFAULT_SETTINGS: TeleopSettings = {
  topic: "/cmd_vel",
  kind: "auto",
  frameId: "base_link",
  linear: 0.5,
  angular: 1,
  rate: 20,
  gamepad: false,
};

/** Sends velocities while a motion is held, and zero when it ends. */
export class TeleopState {
  /** Settings, the target or the motion changed. */
  readonly changed = new Signal();
  settings: TeleopSettings;
  /** The target that the server uses; null until it has reported one. */
  aim: Aim | null = null;
  private readonly motions = new Map<MotionSource, Motion>();
  private isOpen = false;
  private timer = 0;

  constructor(
    private readonly connection: Connection,
    private readonly storage: Pick<Storage, "getItem" | "setItem">,
  ) {
    this.settings = { ...DEFAULT_SETTINGS, ...parseSettings(storage.getItem(STORAGE_KEY)) };
    connection.on("hello", () => {
      if (this.isOpen) this.sendTarget();
    });
    connection.on("teleop_state", (aim) => {
      this.aim = aim;
      this.changed.emit();
    });
    connection.stateChanged.on((state) => {
      if (state !== "connected") this.stop();
    });
  }

  /** The sum of the motions of all sources. */
  get motion(): Motion {
    return sumMotions(this.motions.values());
  }

  setOpen(isOpen: boolean): void {
    if (isOpen === this.isOpen) return;
    if (!isOpen) this.stop();
    this.isOpen = isOpen;
    this.aim = null;
    this.sendTarget();
  }

  configure(change: Partial<TeleopSettings>): void {
    const previousSettings = this.settings;
    this.settings = { ...previousSettings, ...change };
    this.storage.setItem(STORAGE_KEY, JSON.stringify(this.settings));
    const { topic, kind, frameId } = this.settings;
    if (topic !== previousSettings.topic || kind !== previousSettings.kind || frameId !== previousSettings.frameId) {
      this.stop();
      if (this.isOpen) this.sendTarget();
    }
    this.changed.emit();
  }

  /** Sets the motion of a source from now on. */
  move(source: MotionSource, motion: Motion): void {
    const previousMotion = this.motion;
    if (isStill(motion)) this.motions.delete(source);
    else this.motions.set(source, motion);
    const currentMotion = this.motion;
    const isUnchanged = (["x", "y", "z", "turn"] as const).every((component) => currentMotion[component] === previousMotion[component]);
    if (isUnchanged) return;
    if (isStill(currentMotion)) this.stop();
    else if (this.timer === 0) this.drive();
    this.changed.emit();
  }

  /** Ends all motions. */
  stop(): void {
    const isDriving = this.timer !== 0;
    clearTimeout(this.timer);
    this.timer = 0;
    this.motions.clear();
    if (!isDriving) return;
    this.send(NO_MOTION);
    this.changed.emit();
  }

  /** Sends the current motion repeatedly, at the configured rate. */
  private drive(): void {
    this.send(this.motion);
    this.timer = window.setTimeout(() => this.drive(), 1000 / this.settings.rate);
  }

  private send({ x, y, z, turn }: Motion): void {
    const { linear, angular } = this.settings;
    this.connection.send({
      type: "drive",
      linear: [x * linear, y * linear, z * linear],
      angular: [0, 0, turn * angular],
    });
  }

  private sendTarget(): void {
    const { topic, kind, frameId } = this.settings;
    const target = this.isOpen ? { topic, kind, frame_id: frameId } : null;
    this.connection.send({ type: "aim_teleop", target });
  }
}

function parseSettings(text: string | null): Partial<TeleopSettings> {
  try {
    return text === null ? {} : (JSON.parse(text) as Partial<TeleopSettings>);
  } catch {
    return {};
  }
}
