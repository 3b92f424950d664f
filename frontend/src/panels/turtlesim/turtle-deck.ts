import "../../styles/turtlesim.css";
import { coalesce, createButton, h } from "../../dom";
import { createIcon } from "../../icons";
import type { TurtleLines, TurtlePose, TurtleScene } from "../../protocol";
import type { TurtlesimState } from "../../state/turtlesim";
import { strings } from "../../strings";
import { createTurtle } from "./turtle-drawing";

/** The size of the world, and pixels of the world in a unit of turtlesim. */
const SIZE_PX = 500;
const PX_PER_UNIT = 45;

/** All worlds of turtlesim side by side. */
export class TurtleDeck {
  readonly element = h("div", { class: "turtle-deck" });
  private readonly worlds = new Map<number, TurtleWorld>();

  constructor(
    private readonly state: TurtlesimState,
    private readonly drive: (topic: string) => void,
  ) {
    state.simulatorsChanged.on(() => this.arrange());
    state.sceneChanged.on((scene) => this.worlds.get(scene.number)?.show(scene));
    state.linesReceived.on((lines) => this.worlds.get(lines.number)?.addLines(lines));
    state.linesForgotten.on(() => this.worlds.forEach((world) => world.clear()));
    this.arrange();
  }

  private arrange(): void {
    const { simulators } = this.state;
    for (const [number, world] of this.worlds) {
      if (simulators.some((simulator) => simulator.number === number && simulator.name === world.name)) continue;
      world.element.remove();
      this.worlds.delete(number);
    }
    for (const { number, name } of simulators) {
      if (this.worlds.has(number)) continue;
      const world = new TurtleWorld(name, this.drive);
      this.worlds.set(number, world);
      this.element.append(world.element);
    }
  }
}

/** The world of a turtlesim_node: its lines on a canvas, its turtles above it, and their names. */
class TurtleWorld {
  readonly element: HTMLElement;
  private readonly sea: HTMLElement;
  private readonly lines = h("canvas");
  private readonly names = h("div", { class: "turtle-names" });
  private scene: TurtleScene | null = null;
  private shownTopics = "";
  private turtles: readonly HTMLElement[] = [];
  /** Moves the turtles before the next frame. */
  private readonly moveTurtles = coalesce(() => this.move());
  /** The end of the drawing of lines received so far; images are decoded one after another. */
  private decoding = Promise.resolve();

  constructor(
    readonly name: string,
    private readonly drive: (topic: string) => void,
  ) {
    this.lines.width = this.lines.height = SIZE_PX;
    this.sea = h("div", { class: "turtle-sea", role: "img" }, this.lines);
    this.element = h("figure", { class: "turtle-world" }, h("div", { class: "turtle-frame" }, this.sea), h("figcaption", {}, h("span", { class: "turtle-node" }, name), this.names));
  }

  show(scene: TurtleScene): void {
    this.scene = scene;
    this.moveTurtles();
  }

  addLines({ left, top, image }: TurtleLines): void {
    this.decoding = this.decoding.then(async () => {
      const bytes = Uint8Array.from(atob(image), (character) => character.charCodeAt(0));
      const bitmap = await createImageBitmap(new Blob([bytes], { type: "image/png" }));
      const context = this.lines.getContext("2d");
      context?.clearRect(left, top, bitmap.width, bitmap.height);
      context?.drawImage(bitmap, left, top);
      bitmap.close();
    });
  }

  clear(): void {
    this.decoding = this.decoding.then(() => this.lines.getContext("2d")?.clearRect(0, 0, SIZE_PX, SIZE_PX));
  }

  private move(): void {
    if (!this.scene) return;
    const { background, turtles } = this.scene;
    const topics = turtles.map(({ topic, shape }) => `${topic} ${shape}`).join();
    if (topics !== this.shownTopics) {
      this.shownTopics = topics;
      this.replaceTurtles(turtles);
    }
    this.sea.style.backgroundColor = background;
    this.turtles.forEach((element, index) => {
      const turtle = turtles[index];
      if (!turtle) return;
      element.style.left = toPercent(turtle.x * PX_PER_UNIT);
      element.style.top = toPercent(SIZE_PX - 1 - turtle.y * PX_PER_UNIT);
      element.style.rotate = `${-turtle.theta}rad`;
    });
  }

  private replaceTurtles(turtles: readonly TurtlePose[]): void {
    this.sea.ariaLabel = `${this.name}: ${turtles.map(({ name }) => name).join(", ")}`;
    this.turtles = turtles.map(({ shape }) => createTurtle(shape));
    this.sea.replaceChildren(this.lines, ...this.turtles);
    this.names.replaceChildren(...turtles.map((turtle) => this.createTurtleButton(turtle)));
  }

  private createTurtleButton({ name, topic }: TurtlePose): HTMLElement {
    return createButton(strings.turtlesim.driveHint(topic), () => this.drive(topic), "tool", createIcon("teleop"), name);
  }
}

function toPercent(pixels: number): string {
  return `${(100 * pixels) / SIZE_PX}%`;
}
