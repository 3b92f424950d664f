import type { Matrix4 } from "three";
import type { Session } from "../../state/session";
import { strings } from "../../strings";
import { WorldDrawing } from "../displays/world";
import { modelOf } from "../displays/world-models";
import type { Stage } from "../stage";
import type { ToolEvent } from "../tools/tool";
import { HANDLING_TOOLS } from "../world-handling";
import { LightMarks } from "./light-marks";
import { Manipulation } from "./manipulation";
import { Placer } from "./placer";
import { worldFrame } from "./world-frame";

/** Handles the mouse while the world is modelled: selects, moves and adds models and lights. */
export class Modeller {
  private readonly manipulation: Manipulation;
  private readonly placer: Placer;
  private readonly lights: LightMarks;
  private moved: ReadonlyMap<string, Matrix4> = new Map();
  private wasActive = false;

  constructor(
    private readonly stage: Stage,
    private readonly session: Session,
  ) {
    const { modelling, simulation, frames, data } = session;
    this.lights = new LightMarks(modelling);
    stage.overlays.add(this.lights.root);
    this.manipulation = new Manipulation(stage, modelling, (moved) => this.displace(moved));
    this.placer = new Placer(stage, modelling);
    modelling.changed.on(() => this.follow());
    modelling.selectionChanged.on(() => this.select());
    modelling.toolChanged.on(() => {
      this.manipulation.update();
      this.hint();
    });
    modelling.dropped.on(() => this.drop());
    simulation.refused.on(() => this.displace(new Map()));
    for (const signal of [frames.posesChanged, frames.tableChanged]) {
      signal.on(() => {
        if (modelling.active) this.update();
      });
    }
    // A new model is drawn later than it is announced.
    data.received.on(({ content }) => {
      if (modelling.active && content.kind === "world_scene") this.select();
    });
    this.follow();
    this.drop();
  }

  /** Handles an event and returns the event for the active tool; null if the tool is to get none. */
  pointer(event: ToolEvent): ToolEvent | null {
    const { modelling, tools } = this.session;
    if (!modelling.active || (tools.current && !HANDLING_TOOLS.includes(tools.current.cls))) return event;
    if (this.manipulation.pointer(event)) return null;
    const { placing } = modelling;
    if (this.placer.pointer(event)) return null;
    if (event.type !== "up" || !event.click) return event;
    if (event.button === "left" && !placing) this.click(event);
    else if (event.button === "right") this.openMenu(event);
    return { ...event, click: false };
  }

  /** Handles Esc: cancels the drag or the placing in progress, or else clears the selection. */
  escape(): void {
    const { modelling } = this.session;
    if (this.manipulation.cancel()) return;
    if (modelling.placing) modelling.place(null);
    else modelling.select([]);
  }

  private click({ x, y, shift, ctrl }: ToolEvent): void {
    const { modelling } = this.session;
    const name = this.entityAt(x, y);
    if (name !== null) modelling.select([name], shift || ctrl ? "toggle" : "replace");
    else if (!shift && !ctrl) modelling.select([]);
  }

  /** Returns the entity of the world's file under the pointer; the ground does not hide entities. */
  private entityAt(x: number, y: number): string | null {
    const { picker } = this.stage;
    const ray = picker.rayAt(x, y);
    const light = this.lights.pick(ray);
    const found = picker.alongRay(ray);
    if (light && (!found || light.distance < found.hit.distance)) return light.name;
    if (!(found?.drawing instanceof WorldDrawing)) return null;
    const name = modelOf(found.hit.key);
    return this.session.modelling.find(name) && !found.drawing.isFlat(found.hit.key) ? name : null;
  }

  private hint(): void {
    const { modelling, tools } = this.session;
    const words = strings.modelling;
    if (modelling.placing) tools.hint = modelling.placing.kind === "wall" ? words.wallHint : words.placeHint;
  }

  private openMenu(event: ToolEvent): void {
    const { modelling, sceneMenu } = this.session;
    const words = strings.modelling;
    const name = this.entityAt(event.x, event.y);
    if (name === null) return;
    if (!modelling.selected.includes(name)) modelling.select([name]);
    const choices = [
      { label: words.duplicate, run: () => modelling.duplicate() },
      { label: words.remove, run: () => modelling.remove() },
      ...(modelling.canGroup ? [{ label: words.group, run: () => modelling.group() }] : []),
      ...(modelling.canUngroup ? [{ label: words.ungroup, run: () => modelling.ungroup() }] : []),
    ];
    sceneMenu.emit({ x: event.x, y: event.y, choices });
  }

  private drop(): void {
    const drop = this.session.modelling.takeDrop();
    if (!drop) return;
    const { placing, at } = drop;
    const { canvas, size } = this.stage.viewport;
    const box = canvas.getBoundingClientRect();
    if (at) this.placer.drop(placing, at.x - box.left, at.y - box.top);
    else this.placer.drop(placing, size.width / 2, size.height / 2);
  }

  private follow(): void {
    const { modelling, tools } = this.session;
    if (modelling.active !== this.wasActive) {
      this.wasActive = modelling.active;
      if (modelling.active) tools.choose(tools.default);
      else this.displace(new Map());
    }
    this.moved = new Map();
    this.update();
  }

  private displace(moved: ReadonlyMap<string, Matrix4>): void {
    this.moved = moved;
    this.stage.world?.drawing.displace(moved);
    this.lights.update(worldFrame(this.stage), moved);
  }

  private update(): void {
    this.manipulation.update();
    this.lights.update(worldFrame(this.stage), this.moved);
    this.stage.loop.invalidate();
  }

  /** Outlines the selected models in the scene. */
  private select(): void {
    const { stage, session } = this;
    const { world } = stage;
    const links = world ? session.modelling.selected.flatMap((name) => world.drawing.linksOf(name)) : [];
    session.selection.pick(world ? links.map((key) => ({ display: world.id, key })) : [], "replace");
    this.update();
  }
}
