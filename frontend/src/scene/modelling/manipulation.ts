import { Matrix4, Vector3 } from "three";
import type { WorldThing } from "../../protocol";
import type { Modelling } from "../../state/modelling/modelling";
import { resized, scaledSize, stretch, type Change } from "../../state/modelling/shapes";
import type { Stage } from "../stage";
import type { ToolEvent } from "../tools/tool";
import { Gizmo } from "./gizmo";
import { thingMatrix, thingPose } from "./thing-pose";
import { worldFrame } from "./world-frame";

/** m or rad: a smaller difference is not a change. */
const NOTHING = 1e-8;

/** Shows things moved in the world, by the matrices that premultiply their poses. */
export type Displace = (moved: ReadonlyMap<string, Matrix4>) => void;

/** The gizmo on what is selected: moved here at once, in the world when it is let go. */
export class Manipulation {
  private readonly gizmo: Gizmo;
  private changes: readonly Change[] = [];

  constructor(
    private readonly stage: Stage,
    private readonly modelling: Modelling,
    private readonly displace: Displace,
  ) {
    this.gizmo = new Gizmo(stage);
  }

  /** Puts the gizmo where it belongs. */
  update(): void {
    const { modelling } = this;
    if (this.gizmo.held) return;
    const thing = modelling.active && modelling.placing === null ? modelling.selectedThings.at(-1) : undefined;
    const shown = thing && (modelling.gizmo !== "scale" || modelling.canScale);
    this.gizmo.show(shown ? worldFrame(this.stage).multiply(thingMatrix(thing.pose)) : null, modelling.gizmo);
  }

  /** False for an event that others should have. */
  pointer(event: ToolEvent): boolean {
    const { gizmo } = this;
    if (gizmo.held) {
      if (event.type === "move") this.move(event);
      else if (event.type === "up" && event.button === "left") return this.letGo(event);
      return true;
    }
    if (event.type === "down" && event.button === "left") return gizmo.grab(event);
    if (event.type !== "move" || event.left || event.middle || event.right || !gizmo.hover(event)) return false;
    this.stage.viewport.canvas.style.cursor = "grab";
    return true;
  }

  /** Lets go without a change; false when nothing is held. */
  cancel(): boolean {
    if (!this.gizmo.held) return false;
    this.gizmo.cancel();
    this.changes = [];
    this.displace(new Map());
    this.update();
    return true;
  }

  private move(event: ToolEvent): void {
    const { modelling, gizmo } = this;
    const steps = modelling.snapping.steps(event.ctrl);
    gizmo.drag(event, steps);
    const things = modelling.selectedThings;
    const main = things.at(-1);
    if (!main) return;
    if (modelling.gizmo === "scale") this.scale(main, steps.length);
    else this.carry(things, main);
  }

  /** False for a mere click, which is for what is behind the handle. */
  private letGo(event: ToolEvent): boolean {
    const { changes } = this;
    this.gizmo.release(event);
    this.changes = [];
    this.modelling.change(changes);
    this.update();
    return changes.length > 0;
  }

  /** All go with the thing that the gizmo is on. */
  private carry(things: readonly WorldThing[], main: WorldThing): void {
    const to = worldFrame(this.stage).invert().multiply(this.gizmo.pose);
    const by = to.multiply(thingMatrix(main.pose).invert());
    const moved = things.map(({ name, pose }) => ({ name, pose: thingPose(by.clone().multiply(thingMatrix(pose))) }));
    this.changes = same(moved.flatMap(({ pose }) => pose), things.flatMap(({ pose }) => pose)) ? [] : moved;
    this.displace(new Map(things.map(({ name }) => [name, by])));
  }

  private scale(thing: WorldThing, step: number): void {
    const { name, shape, size, pose } = thing;
    if (shape === null) return;
    const next = scaledSize(shape, size, this.gizmo.scale, step);
    const change = resized(thing, next);
    const stretched = new Matrix4().scale(new Vector3(...stretch(shape, size, next)));
    this.changes = same(size, next) ? [] : [change];
    this.displace(new Map([[name, thingMatrix(change.pose ?? pose).multiply(stretched).multiply(thingMatrix(pose).invert())]]));
  }
}

function same(some: readonly number[], others: readonly number[]): boolean {
  return some.every((value, i) => Math.abs(value - (others[i] ?? NaN)) < NOTHING);
}
