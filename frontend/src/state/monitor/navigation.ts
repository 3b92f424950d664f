import type { Connection } from "../../connection/connection";
import type { GoalOutcome, NavigationCommand, NavigationState as ServerState } from "../../protocol";
import { Signal } from "../../signal";

/** The state of nav2, which is requested only while the panel is visible. */
export class NavigationState {
  readonly changed = new Signal();
  /** A goal failed, or another was accepted. */
  readonly outcomeChanged = new Signal<GoalOutcome>();
  /** The last state; null until the server has reported one. */
  lastState: ServerState | null = null;
  private isOpen = false;

  constructor(private readonly connection: Connection) {
    connection.on("hello", () => {
      if (this.isOpen) this.sendWatch();
    });
    connection.on("navigation_state", (state) => {
      this.lastState = state;
      this.changed.emit();
    });
    connection.on("goal_outcome", (outcome) => this.outcomeChanged.emit(outcome));
  }

  setOpen(isOpen: boolean): void {
    if (isOpen === this.isOpen) return;
    this.isOpen = isOpen;
    this.sendWatch();
  }

  sendCommand(command: NavigationCommand): void {
    this.connection.send({ type: "command_navigation", command });
  }

  private sendWatch(): void {
    this.connection.send({ type: "watch_navigation", open: this.isOpen });
  }
}
