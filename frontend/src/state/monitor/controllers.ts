import type { Connection } from "../../connection/connection";
import type { ControllerAction, ControllerList, HardwareState } from "../../protocol";
import { Signal } from "../../signal";

/** The controllers and the hardware of a controller manager. */
export class ControllersState {
  readonly managersChanged = new Signal();
  readonly changed = new Signal();
  managers: readonly string[] = [];
  manager: string | null = null;
  /** The controllers of the manager; null until it has answered. */
  list: ControllerList | null = null;
  /** Why the last change of each controller or hardware component failed. */
  readonly problems = new Map<string, string>();
  private isWatching = false;

  constructor(private readonly connection: Connection) {
    connection.on("hello", () => {
      if (this.isWatching) this.sendWatch();
    });
    connection.on("controller_managers", ({ managers }) => {
      this.managers = managers;
      this.managersChanged.emit();
      if (this.manager === null && managers[0] !== undefined) this.choose(managers[0]);
    });
    connection.on("controller_list", (list) => {
      if (list.manager !== this.manager) return;
      this.list = list;
      this.changed.emit();
    });
    connection.on("controller_result", ({ manager, name, text }) => {
      if (manager !== this.manager) return;
      if (text === "") this.problems.delete(name);
      else this.problems.set(name, text);
      this.changed.emit();
    });
  }

  watch(isWatched: boolean): void {
    if (isWatched === this.isWatching) return;
    this.isWatching = isWatched;
    this.sendWatch();
  }

  choose(manager: string): void {
    this.manager = manager;
    this.list = null;
    this.problems.clear();
    this.changed.emit();
    this.sendWatch();
  }

  changeController(name: string, action: ControllerAction): void {
    if (this.manager !== null) this.connection.send({ type: "change_controller", manager: this.manager, name, action });
  }

  changeHardware(name: string, state: HardwareState): void {
    if (this.manager !== null) this.connection.send({ type: "change_hardware", manager: this.manager, name, state });
  }

  private sendWatch(): void {
    const manager = this.isWatching ? this.manager : null;
    this.connection.send({ type: "watch_controllers", wants_list: this.isWatching, manager });
  }
}

/** Returns the actions that lead from a state of a controller to the next states. */
export function listActions(state: string): readonly ControllerAction[] {
  switch (state) {
    case "not loaded":
      return ["load"];
    case "unconfigured":
      return ["configure", "unload"];
    case "inactive":
      return ["activate", "unload"];
    case "active":
      return ["deactivate"];
    default:
      return [];
  }
}

const HARDWARE_STATES: readonly HardwareState[] = ["unconfigured", "inactive", "active"];

/** Returns the states to which a hardware component can change. */
export function listHardwareStates(state: string): readonly HardwareState[] {
  return HARDWARE_STATES.filter((other) => other !== state);
}
