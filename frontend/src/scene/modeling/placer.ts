import { Group } from "three";
import type { Modeling, Placing } from "../../state/modeling/modeling";
import { placementAt, wallPlacementBetween, type GroundPosition, type Placement } from "../../state/modeling/shapes";
import { snap } from "../../state/modeling/snapping";
import type { Stage } from "../stage";
import type { ToolEvent } from "../tools/tool";
import { Ghost } from "./ghost";
import { groundPositionAt, computeWorldFrame } from "./world-frame";

/** Places the chosen entity on the ground: with a click, or a wall by dragging or with two clicks. */
export class Placer {
  private readonly ghost = new Ghost();
  /** A group in the world's frame. */
  private readonly world = new Group();
  private wallStart: GroundPosition | null = null;
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
    if (event.type === "leave") this.showGhost(placing, null);
    if (placing.kind === "wall") return this.onWallPointer(placing, event);
    const placement = this.placementAt(placing, event);
    if (event.type === "move" && !event.isLeftDown) this.showGhost(placing, placement);
    if (event.type !== "up" || !event.isClick || event.button !== "left") return event.type === "move" && !isAnyButtonPressed(event);
    if (placement) this.add(placing, placement, event.isShiftDown);
    return false;
  }

  /** Places an entity at the pointer. */
  drop(placing: Placing, x: number, y: number): void {
    const position = this.snapToGround(x, y, false);
    if (position && placing.kind !== "wall") this.add(placing, placementAt(placing.kind, position), false);
    else if (position) this.add(placing, wallPlacementBetween([position[0] - 0.5, position[1]], [position[0] + 0.5, position[1]]), false);
  }

  private onWallPointer(placing: Placing, event: ToolEvent): boolean {
    const position = this.snapToGround(event.x, event.y, event.isCtrlDown);
    if (event.type === "down" && event.button === "left" && !this.hasFirstEnd) this.wallStart = position;
    const placement = this.wallStart && position && wallPlacementBetween(this.wallStart, position);
    if (event.type === "move" && !event.isMiddleDown && !event.isRightDown) {
      this.showGhost(placing, placement ?? (position && { pose: [...position, 0, 0, 0, 0], size: [0.1, 0.1, 1] }));
      return true;
    }
    if (event.type !== "up" || event.button !== "left") return event.isLeftDown;
    if (event.isClick && !this.hasFirstEnd) this.hasFirstEnd = this.wallStart !== null;
    else {
      if (placement) this.add(placing, placement, true);
      this.wallStart = null;
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
    const position = this.snapToGround(event.x, event.y, event.isCtrlDown);
    return position && placementAt(kind, position);
  }

  private snapToGround(x: number, y: number, isInverted: boolean): GroundPosition | null {
    const position = groundPositionAt(this.stage, x, y);
    const step = this.modeling.snapping.chooseSteps(isInverted).length;
    return position && [snap(position[0], step), snap(position[1], step)];
  }

  private showGhost({ kind }: Placing, placement: Placement | null): void {
    this.world.matrix.copy(computeWorldFrame(this.stage));
    this.ghost.show(kind, placement);
    this.stage.loop.invalidate();
  }

  private reset(): void {
    this.wallStart = null;
    this.hasFirstEnd = false;
    this.ghost.hide();
    this.stage.loop.invalidate();
  }
}

function isAnyButtonPressed({ isLeftDown, isMiddleDown, isRightDown }: ToolEvent): boolean {
  return isLeftDown || isMiddleDown || isRightDown;
}
