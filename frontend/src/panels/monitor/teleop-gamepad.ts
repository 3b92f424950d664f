import type { TeleopState } from "../../state/monitor/teleop";
import { NO_MOTION, computeDeflection } from "../../state/monitor/teleop-keys";

/** LB and RB in the standard layout; one of them must be held to drive. */
const DEAD_MAN_BUTTONS = [4, 5];

/** Reads the first gamepad while it is enabled: the left stick drives, the right one moves sideways. */
export class TeleopGamepad {
  private frameRequest = 0;
  private lastName: string | null = "";

  /** @param onNameChanged - called with the name of the gamepad, or null when there is none. */
  constructor(
    private readonly state: TeleopState,
    private readonly onNameChanged: (name: string | null) => void,
  ) {}

  /** Starts or stops reading the gamepad. */
  setRunning(isRunning: boolean): void {
    cancelAnimationFrame(this.frameRequest);
    this.frameRequest = 0;
    if (isRunning) this.readGamepad();
    else this.state.move("gamepad", NO_MOTION);
  }

  private readGamepad(): void {
    this.frameRequest = requestAnimationFrame(() => this.readGamepad());
    const pad = navigator.getGamepads().find((gamepad) => gamepad !== null && gamepad.connected) ?? null;
    const name = pad?.id ?? null;
    if (name !== this.lastName) {
      this.lastName = name;
      this.onNameChanged(name);
    }
    const isHeld = pad !== null && DEAD_MAN_BUTTONS.some((button) => pad.buttons[button]?.pressed === true);
    const deflectionOf = (index: number): number => computeDeflection(pad?.axes[index] ?? 0);
    const motion = isHeld ? { x: -deflectionOf(1), y: -deflectionOf(2), z: 0, turn: -deflectionOf(0) } : NO_MOTION;
    this.state.move("gamepad", { ...motion, x: motion.x || 0, y: motion.y || 0, turn: motion.turn || 0 });
  }
}
