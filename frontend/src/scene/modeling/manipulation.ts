import { Matrix4, Vector3 } from "three";
import type { WorldEntity } from "../../protocol";
import type { Modeling } from "../../state/modeling/modeling";
import { createResizeChange, scaleSize, computeStretchFactors, type Change } from "../../state/modeling/shapes";
import type { Stage } from "../stage";
import type { ToolEvent } from "../tools/tool";
import { Gizmo } from "./gizmo";
import { createEntityMatrix, readEntityPose } from "./entity-pose";
import { computeWorldFrame } from "./world-frame";

/** The smallest difference that counts as a change, m or rad. */
const MIN_CHANGE = 1e-8;

/** Shows entities displaced in the world, by the matrices that premultiply their poses. */
export type Displace = (displacements: ReadonlyMap<string, Matrix4>) => void;

/** The gizmo on the selection: dragging shows the change immediately, and releasing applies it to the world. */
export class Manipulation {
  private readonly gizmo: Gizmo;
  private changes: readonly Change[] = [];

  constructor(
    private readonly stage: Stage,
    private readonly modeling: Modeling,
    private readonly displace: Displace,
  ) {
    this.gizmo = new Gizmo(stage);
  }

  /** Moves the gizmo to the selection. */
  update(): void {
    const { modeling } = this;
    if (this.gizmo.isHeld) return;
    const entity = modeling.isActive && modeling.placing === null ? modeling.selectedEntities.at(-1) : undefined;
    const isShown = entity && (modeling.gizmo !== "scale" || modeling.canScale);
    this.gizmo.show(isShown ? computeWorldFrame(this.stage).multiply(createEntityMatrix(entity.pose)) : null, modeling.gizmo);
  }

  /** Handles an event; returns false if it is left to others. */
  onPointer(event: ToolEvent): boolean {
    const { gizmo } = this;
    if (gizmo.isHeld) {
      if (event.type === "move") this.drag(event);
      else if (event.type === "up" && event.button === "left") return this.release(event);
      return true;
    }
    if (event.type === "down" && event.button === "left") return gizmo.grab(event);
    if (event.type !== "move" || event.isLeftDown || event.isMiddleDown || event.isRightDown || !gizmo.hover(event)) return false;
    this.stage.viewport.canvas.style.cursor = "grab";
    return true;
  }

  /** Cancels the drag; returns false if none is in progress. */
  cancel(): boolean {
    if (!this.gizmo.isHeld) return false;
    this.gizmo.cancel();
    this.changes = [];
    this.displace(new Map());
    this.update();
    return true;
  }

  private drag(event: ToolEvent): void {
    const { modeling, gizmo } = this;
    const steps = modeling.snapping.chooseSteps(event.isCtrlDown);
    gizmo.drag(event, steps);
    const entities = modeling.selectedEntities;
    const primary = entities.at(-1);
    if (!primary) return;
    if (modeling.gizmo === "scale") this.scaleEntity(primary, steps.length);
    else this.moveSelection(entities, primary);
  }

  /** Ends the drag; returns false for a mere click, which is meant for the object behind the handle. */
  private release(event: ToolEvent): boolean {
    const { changes } = this;
    this.gizmo.release(event);
    this.changes = [];
    this.modeling.change(changes);
    this.update();
    return changes.length > 0;
  }

  /** Moves all selected entities together with the one that has the gizmo. */
  private moveSelection(entities: readonly WorldEntity[], primary: WorldEntity): void {
    const newPose = computeWorldFrame(this.stage).invert().multiply(this.gizmo.pose);
    const motion = newPose.multiply(createEntityMatrix(primary.pose).invert());
    const changes = entities.map(({ name, pose }) => ({ name, pose: readEntityPose(motion.clone().multiply(createEntityMatrix(pose))) }));
    this.changes = areNearlyEqual(changes.flatMap(({ pose }) => pose), entities.flatMap(({ pose }) => pose)) ? [] : changes;
    this.displace(new Map(entities.map(({ name }) => [name, motion])));
  }

  private scaleEntity(entity: WorldEntity, step: number): void {
    const { name, shape, size, pose } = entity;
    if (shape === null) return;
    const newSize = scaleSize(shape, size, this.gizmo.scale, step);
    const change = createResizeChange(entity, newSize);
    const stretch = new Matrix4().scale(new Vector3(...computeStretchFactors(shape, size, newSize)));
    this.changes = areNearlyEqual(size, newSize) ? [] : [change];
    this.displace(new Map([[name, createEntityMatrix(change.pose ?? pose).multiply(stretch).multiply(createEntityMatrix(pose).invert())]]));
  }
}

function areNearlyEqual(first: readonly number[], second: readonly number[]): boolean {
  return first.every((value, i) => Math.abs(value - (second[i] ?? NaN)) < MIN_CHANGE);
}
