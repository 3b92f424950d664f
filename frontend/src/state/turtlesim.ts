import type { Connection } from "../connection/connection";
import type { TurtleLines, TurtleScene, TurtleSimulator } from "../protocol";
import { Signal } from "../signal";

/** The turtlesim_nodes of the program, and their turtles. */
export class TurtlesimState {
  readonly simulatorsChanged = new Signal();
  readonly sceneChanged = new Signal<TurtleScene>();
  /** Lines to draw, in order. */
  readonly linesReceived = new Signal<TurtleLines>();
  /** All lines are sent again. */
  readonly linesForgotten = new Signal();
  simulators: readonly TurtleSimulator[] = [];
  readonly scenes = new Map<number, TurtleScene>();
  private isWatching = false;

  constructor(private readonly connection: Connection) {
    connection.on("hello", () => {
      this.scenes.clear();
      this.linesForgotten.emit();
      if (this.isWatching) this.sendWatch();
    });
    connection.on("turtle_simulators", ({ simulators }) => {
      this.simulators = simulators;
      this.simulatorsChanged.emit();
    });
    connection.on("turtle_scene", (scene) => {
      this.scenes.set(scene.number, scene);
      this.sceneChanged.emit(scene);
    });
    connection.on("turtle_lines", (lines) => this.linesReceived.emit(lines));
  }

  watch(isWatched: boolean): void {
    if (isWatched === this.isWatching) return;
    this.isWatching = isWatched;
    this.sendWatch();
  }

  /** Returns the simulators with their turtles for `window.linkwright`. */
  inspect(): object {
    return this.simulators.map(({ number, name }) => ({ name, ...this.scenes.get(number) }));
  }

  private sendWatch(): void {
    this.connection.send({ type: "watch_turtles", is_watched: this.isWatching });
  }
}
