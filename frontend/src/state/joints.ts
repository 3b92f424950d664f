import type { Connection } from "../connection/connection";
import type { JointControl } from "../protocol";
import { Signal } from "../signal";
import type { PageMemory } from "./page-memory";

/** The maximum number of joints in one message, because the server accepts messages of 64 KiB. */
const MAX_PER_MESSAGE = 200;

export type Positions = Readonly<Record<string, number>>;

/** The joints of the Joints panel, and the last positions from the server. */
export class JointsState {
  readonly controlsChanged = new Signal();
  readonly positionsChanged = new Signal();
  /** The controllable joints; null while no sliders publish positions. */
  controls: readonly JointControl[] | null = null;
  positions: Positions = {};
  /** Whether links can be dragged without Alt. */
  dragsWithoutAlt = false;
  private pending: Record<string, number> | null = null;
  /** The latest joints, also after the program has ended. */
  private latest: readonly JointControl[] = [];
  /** The joint positions from before a restart of the program, until the new program has sliders. */
  private beforeRestart: Positions = {};

  constructor(
    private readonly connection: Connection,
    private readonly nextFrame: (work: () => void) => void = (work) => void requestAnimationFrame(work),
  ) {
    connection.on("joints", ({ controls }) => this.setControls(controls));
    connection.on("joint_positions", ({ positions }) => this.setPositions(positions));
  }

  /** Preserves across reloads of the page whether links can be dragged without Alt. */
  preserveIn(memory: PageMemory): void {
    memory.preserve("hands on", () => this.dragsWithoutAlt, (on) => (this.dragsWithoutAlt = on));
  }

  /**
   * Moves joints, rad or m. The first move is sent immediately; further moves until the next animation frame are sent
   * together.
   */
  move(positions: Positions): void {
    if (this.pending) {
      Object.assign(this.pending, positions);
      return;
    }
    this.send(positions);
    this.pending = {};
    this.nextFrame(() => {
      const late = this.pending ?? {};
      this.pending = null;
      if (Object.keys(late).length > 0) this.move(late);
    });
  }

  /** Returns the joint that must be moved so that `name` gets to `position`, and its position; null if no joint can. */
  leader(name: string, position: number): { control: JointControl; position: number } | null {
    const seen = new Set<string>();
    for (let at = position, next = name; !seen.has(next); ) {
      seen.add(next);
      const control = this.controls?.find((each) => each.name === next);
      if (!control) return null;
      if (control.mimic === null) return { control, position: at };
      if (control.multiplier === 0) return null;
      at = (at - control.offset) / control.multiplier;
      next = control.mimic;
    }
    return null;
  }

  /** Moves joints back to their positions after the program was restarted, if it shows the same robot. */
  programRestarted(isSame: boolean): void {
    const moved = this.latest.filter(({ name, mimic, zero }) => mimic === null && this.positions[name] !== zero);
    const before = moved.map(({ name }) => [name, this.positions[name]]).filter(([, position]) => position !== undefined);
    this.beforeRestart = isSame ? { ...this.beforeRestart, ...(Object.fromEntries(before) as Positions) } : {};
  }

  private setControls(controls: readonly JointControl[] | null): void {
    this.controls = controls;
    this.controlsChanged.emit();
    if (controls === null || controls.length === 0) return;
    this.latest = controls;
    const known = new Set(controls.map(({ name }) => name));
    const found = Object.entries(this.beforeRestart).filter(([name]) => known.has(name));
    this.beforeRestart = {};
    this.send(Object.fromEntries(found));
  }

  private setPositions(positions: Positions): void {
    this.positions = positions;
    this.positionsChanged.emit();
  }

  private send(positions: Positions): void {
    const entries = Object.entries(positions);
    const [only] = entries;
    if (only && entries.length === 1) {
      this.connection.send({ type: "set_joint", name: only[0], position: only[1] });
      return;
    }
    for (let i = 0; i < entries.length; i += MAX_PER_MESSAGE) {
      const part = Object.fromEntries(entries.slice(i, i + MAX_PER_MESSAGE));
      this.connection.send({ type: "set_joints", positions: part });
    }
  }
}
