import { Group } from "three";
import type { Modeling, Placing } from "../../state/modeling/modeling";
import { placementAt, placeWall, type Place, type Placement } from "../../state/modeling/shapes";
import { snap } from "../../state/modeling/snapping";
import type { Stage } from "../stage";
import type { ToolEvent } from "../tools/tool";
import { Ghost } from "./ghost";
import { groundAt, computeWorldFrame } from "./world-frame";

/** Places the chosen entity on the ground: with a click, or a wall by dragging or with two clicks. */
export class Placer {
  private readonly ghost = new Ghost();
  /** A group in the world's frame. */
  private readonly world = new Group();
  private start: Place | null = null;
  /** Whether the first end of a wall was clicked, so that the next click is its second end. */
  private hasFirstEnd = false;

  constructor(
    private readonly stage: Stage,
    private readonly modeling: Modeling,
  ) {
    this.world.matrixAutoUpdate = false;
    this.world.add(this.ghost.root);
    stage.overlays.add(this.world);
    modeling.toolChanged.on(() => this.reset());
  }

  /** Handles an event; returns false if it is left to others. */
  onPointer(event: ToolEvent): boolean {
    const { placing } = this.modeling;
    if (!placing || event.type === "wheel") return false;
    if (event.type === "leave") this.show(placing, null);
    if (placing.kind === "wall") return this.handleWall(placing, event);
    const placement = this.placementAt(placing, event);
    if (event.type === "move" && !event.left) this.show(placing, placement);
    if (event.type !== "up" || !event.click || event.button !== "left") return event.type === "move" && !isPressed(event);
    if (placement) this.add(placing, placement, event.shift);
    return false;
  }

  /** Places an entity at the pointer. */
  drop(placing: Placing, x: number, y: number): void {
    const position = this.placeOnGround(x, y, false);
    if (position && placing.kind !== "wall") this.add(placing, placementAt(placing.kind, position), false);
    else if (position) this.add(placing, placeWall([position[0] - 0.5, position[1]], [position[0] + 0.5, position[1]]), false);
  }

  private handleWall(placing: Placing, event: ToolEvent): boolean {
    const position = this.placeOnGround(event.x, event.y, event.ctrl);
    if (event.type === "down" && event.button === "left" && !this.hasFirstEnd) this.start = position;
    const placement = this.start && position && placeWall(this.start, position);
    if (event.type === "move" && !event.middle && !event.right) {
      this.show(placing, placement ?? (position && { pose: [...position, 0, 0, 0, 0], size: [0.1, 0.1, 1] }));
      return true;
    }
    if (event.type !== "up" || event.button !== "left") return event.left;
    if (event.click && !this.hasFirstEnd) this.hasFirstEnd = this.start !== null;
    else {
      if (placement) this.add(placing, placement, true);
      this.start = null;
      this.hasFirstEnd = false;
    }
    return true;
  }

  private add(placing: Placing, placement: Placement | null, staysActive: boolean): void {
    if (!placement) return;
    this.modeling.add(placing, placement);
    if (!staysActive) this.modeling.startPlacing(null);
  }

  private placementAt({ kind }: Placing, event: ToolEvent): Placement | null {
    const position = this.placeOnGround(event.x, event.y, event.ctrl);
    return position && placementAt(kind, position);
  }

  private placeOnGround(x: number, y: number, isInverted: boolean): Place | null {
    const position = groundAt(this.stage, x, y);
    const step = this.modeling.snapping.chooseSteps(isInverted).length;
    return position && [snap(position[0], step), snap(position[1], step)];
  }

  private show({ kind }: Placing, placement: Placement | null): void {
    this.world.matrix.copy(computeWorldFrame(this.stage));
    this.ghost.show(kind, placement);
    this.stage.loop.invalidate();
  }

  private reset(): void {
    this.start = null;
    this.hasFirstEnd = false;
    this.ghost.hide();
    this.stage.loop.invalidate();
  }
}

function isPressed({ left, middle, right }: ToolEvent): boolean {
  return left || middle || right;
}
