import "../../styles/turtlesim.css";
import { createButton, h } from "../../dom";
import { createIcon } from "../../icons";
import type { TurtleLines, TurtlePose, TurtleScene } from "../../protocol";
import type { TurtlesimState } from "../../state/turtlesim";
import { strings } from "../../strings";
import { drawTurtle } from "./turtle-drawing";

/** The size of the world, and pixels of the world in a unit of turtlesim. */
const SIZE_PX = 500;
const PX_PER_UNIT = 45;
/** More pixels of the screen than in the world, for sharp turtles. */
const SCALE = 2;

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

/** The canvas of a turtlesim_node, and the names of its turtles. */
class TurtleWorld {
  readonly element: HTMLElement;
  private readonly canvas = h("canvas", { class: "turtle-canvas", role: "img" });
  private readonly lines = new OffscreenCanvas(SIZE_PX, SIZE_PX);
  private readonly turtles = h("div", { class: "turtle-names" });
  private scene: TurtleScene | null = null;
  private shownTopics = "";
  /** The end of the drawing of lines received so far; images are decoded one after another. */
  private decoding = Promise.resolve();

  constructor(
    readonly name: string,
    private readonly drive: (topic: string) => void,
  ) {
    this.canvas.width = this.canvas.height = SIZE_PX * SCALE;
    this.element = h("figure", { class: "turtle-world" }, h("div", { class: "turtle-frame" }, this.canvas), h("figcaption", {}, h("span", { class: "turtle-node" }, name), this.turtles));
  }

  show(scene: TurtleScene): void {
    this.scene = scene;
    const topics = scene.turtles.map(({ topic }) => topic).join();
    if (topics !== this.shownTopics) {
      this.shownTopics = topics;
      this.canvas.ariaLabel = `${this.name}: ${scene.turtles.map(({ name }) => name).join(", ")}`;
      this.turtles.replaceChildren(...scene.turtles.map((turtle) => this.createTurtleButton(turtle)));
    }
    this.draw();
  }

  addLines({ left, top, image }: TurtleLines): void {
    this.decoding = this.decoding.then(async () => {
      const bytes = Uint8Array.from(atob(image), (character) => character.charCodeAt(0));
      const bitmap = await createImageBitmap(new Blob([bytes], { type: "image/png" }));
      const context = this.lines.getContext("2d");
      context?.clearRect(left, top, bitmap.width, bitmap.height);
      context?.drawImage(bitmap, left, top);
      bitmap.close();
      this.draw();
    });
  }

  clear(): void {
    this.decoding = this.decoding.then(() => this.lines.getContext("2d")?.clearRect(0, 0, SIZE_PX, SIZE_PX));
  }

  private createTurtleButton({ name, topic }: TurtlePose): HTMLElement {
    return createButton(strings.turtlesim.driveHint(topic), () => this.drive(topic), "tool", createIcon("teleop"), name);
  }

  private draw(): void {
    const context = this.canvas.getContext("2d");
    if (!context || !this.scene) return;
    context.setTransform(SCALE, 0, 0, SCALE, 0, 0);
    context.fillStyle = this.scene.background;
    context.fillRect(0, 0, SIZE_PX, SIZE_PX);
    context.drawImage(this.lines, 0, 0);
    for (const { x, y, theta, shape } of this.scene.turtles) {
      context.save();
      context.translate(x * PX_PER_UNIT, SIZE_PX - 1 - y * PX_PER_UNIT);
      context.rotate(-theta);
      drawTurtle(context, shape);
      context.restore();
    }
  }
}
