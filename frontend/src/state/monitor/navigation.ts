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
  private opened = false;

  constructor(private readonly connection: Connection) {
    connection.on("hello", () => {
      if (this.opened) this.sendWatch();
    });
    connection.on("navigation_state", (state) => {
      this.lastState = state;
      this.changed.emit();
    });
    connection.on("goal_outcome", (outcome) => this.outcomeChanged.emit(outcome));
  }

  setOpen(opened: boolean): void {
    if (opened === this.opened) return;
    this.opened = opened;
    this.sendWatch();
  }

  command(command: NavigationCommand): void {
    this.connection.send({ type: "command_navigation", command });
  }

  private sendWatch(): void {
    this.connection.send({ type: "watch_navigation", open: this.opened });
  }
}
