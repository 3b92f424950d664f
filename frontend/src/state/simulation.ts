import type { Connection } from "../connection/connection";
import type { ControlSimulation, SimulationStatus } from "../protocol";
import { Signal } from "../signal";

/** The simulation in the graph, if there is one, as the server reports it. */
export class SimulationState {
  readonly changed = new Signal();
  /** The simulation refused a request; the value is the reason. */
  readonly refused = new Signal<string>();
  /** A model that this page requested was added to the world; the value is its name. */
  readonly added = new Signal<string>();
  /** The user asked to add a model at a position in the world, m. */
  readonly spawnRequested = new Signal<readonly number[]>();
  /** Returns a free position for a model in the world, m; the drawing of a world replaces this function. */
  findFreePosition: () => readonly number[] = () => [0, 0, 0];
  private status: SimulationStatus | null = null;

  constructor(private readonly connection: Connection) {
    connection.on("simulation_status", (status) => {
      this.status = status;
      this.changed.emit();
    });
    connection.on("model_added", ({ name }) => this.added.emit(name));
    connection.on("simulation_notice", ({ text }) => this.refused.emit(text));
  }

  get isPresent(): boolean {
    return this.status?.present ?? false;
  }

  get isPaused(): boolean {
    return this.status?.paused ?? false;
  }

  /** Simulated time, s; null until the server has reported it. */
  get time(): number | null {
    return this.status?.time ?? null;
  }

  /** The real-time factor: simulated seconds per second. */
  get realTimeFactor(): number | null {
    return this.status?.real_time_factor ?? null;
  }

  sendControl(action: ControlSimulation["action"]): void {
    this.connection.send({ type: "control_simulation", action });
  }

  /** Adds a model; `address` is a path, or starts with package:// or model://. */
  spawn(address: string, position: readonly number[]): void {
    this.connection.send({ type: "spawn_model", address, position: [...position] });
  }

  remove(model: string): void {
    this.connection.send({ type: "delete_model", model });
  }

  /** Moves a model by an offset in the world's frame, m, from its position at the start of the drag. */
  drag(model: string, offset: readonly number[], isStart: boolean): void {
    this.connection.send({ type: "drag_model", model, begins: isStart, offset: [...offset] });
  }

  /** Pushes a link briefly: `force` in the world's frame, N; `point` in the link's frame, m. */
  push(link: string, point: readonly number[], force: readonly number[]): void {
    this.connection.send({ type: "push_link", link, point: [...point], force: [...force] });
  }
}
