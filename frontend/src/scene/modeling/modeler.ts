import type { Matrix4 } from "three";
import type { Session } from "../../state/session";
import { strings } from "../../strings";
import { WorldDrawing } from "../displays/world";
import { modelOf } from "../displays/world-models";
import type { Stage } from "../stage";
import type { ToolEvent } from "../tools/tool";
import { PASSIVE_TOOLS } from "../world-handling";
import { LightMarks } from "./light-marks";
import { Manipulation } from "./manipulation";
import { Placer } from "./placer";
import { computeWorldFrame } from "./world-frame";

/** Handles the mouse while the world is modeled: selects, moves and adds models and lights. */
export class Modeler {
  private readonly manipulation: Manipulation;
  private readonly placer: Placer;
  private readonly lights: LightMarks;
  private displacements: ReadonlyMap<string, Matrix4> = new Map();
  private wasActive = false;

  constructor(
    private readonly stage: Stage,
    private readonly session: Session,
  ) {
    const { modeling, simulation, frames, data } = session;
    this.lights = new LightMarks(modeling);
    stage.overlays.add(this.lights.root);
    this.manipulation = new Manipulation(stage, modeling, (displacements) => this.displace(displacements));
    this.placer = new Placer(stage, modeling);
    modeling.changed.on(() => this.onModelingChanged());
    modeling.selectionChanged.on(() => this.outlineSelection());
    modeling.toolChanged.on(() => {
      this.manipulation.update();
      this.showHint();
    });
    modeling.dropped.on(() => this.placeDropped());
    simulation.refused.on(() => this.displace(new Map()));
    for (const signal of [frames.posesChanged, frames.tableChanged]) {
      signal.on(() => {
        if (modeling.isActive) this.update();
      });
    }
    // A new model is announced before it is drawn.
    data.received.on(({ content }) => {
      if (modeling.isActive && content.kind === "world_scene") this.outlineSelection();
    });
    this.onModelingChanged();
    this.placeDropped();
  }

  /** Handles an event. Returns the event to pass to the active tool; null to pass none. */
  onPointer(event: ToolEvent): ToolEvent | null {
    const { modeling, tools } = this.session;
    if (!modeling.isActive || (tools.current && !PASSIVE_TOOLS.includes(tools.current.cls))) return event;
    if (this.manipulation.onPointer(event)) return null;
    const { placing } = modeling;
    if (this.placer.onPointer(event)) return null;
    if (event.type !== "up" || !event.isClick) return event;
    if (event.button === "left" && !placing) this.onClick(event);
    else if (event.button === "right") this.openMenu(event);
    return { ...event, isClick: false };
  }

  /** Handles Esc: cancels the drag or the placing in progress, or else clears the selection. */
  escape(): void {
    const { modeling } = this.session;
    if (this.manipulation.cancel()) return;
    if (modeling.placing) modeling.startPlacing(null);
    else modeling.select([]);
  }

  private onClick({ x, y, isShiftDown, isCtrlDown }: ToolEvent): void {
    const { modeling } = this.session;
    const name = this.entityAt(x, y);
    if (name !== null) modeling.select([name], isShiftDown || isCtrlDown ? "toggle" : "replace");
    else if (!isShiftDown && !isCtrlDown) modeling.select([]);
  }

  /** Returns the entity of the world's file under the pointer; the ground does not hide entities. */
  private entityAt(x: number, y: number): string | null {
    const { picker } = this.stage;
    const ray = picker.rayAt(x, y);
    const light = this.lights.pick(ray);
    const picked = picker.pickAlongRay(ray);
    if (light && (!picked || light.distance < picked.hit.distance)) return light.name;
    if (!(picked?.drawing instanceof WorldDrawing)) return null;
    const name = modelOf(picked.hit.key);
    return this.session.modeling.find(name) && !picked.drawing.isFlat(picked.hit.key) ? name : null;
  }

  private showHint(): void {
    const { modeling, tools } = this.session;
    const texts = strings.modeling;
    if (modeling.placing) tools.hint = modeling.placing.kind === "wall" ? texts.wallHint : texts.placeHint;
  }

  private openMenu(event: ToolEvent): void {
    const { modeling, sceneMenu } = this.session;
    const texts = strings.modeling;
    const name = this.entityAt(event.x, event.y);
    if (name === null) return;
    if (!modeling.selectedNames.includes(name)) modeling.select([name]);
    const choices = [
      { label: texts.duplicate, run: () => modeling.duplicate() },
      { label: texts.remove, run: () => modeling.remove() },
      ...(modeling.canGroup ? [{ label: texts.group, run: () => modeling.groupSelected() }] : []),
      ...(modeling.canUngroup ? [{ label: texts.ungroup, run: () => modeling.ungroupSelected() }] : []),
    ];
    sceneMenu.emit({ x: event.x, y: event.y, choices });
  }

  private placeDropped(): void {
    const drop = this.session.modeling.takeDrop();
    if (!drop) return;
    const { placing, position } = drop;
    const { canvas, size } = this.stage.viewport;
    const canvasRect = canvas.getBoundingClientRect();
    if (position) this.placer.drop(placing, position.x - canvasRect.left, position.y - canvasRect.top);
    else this.placer.drop(placing, size.width / 2, size.height / 2);
  }

  private onModelingChanged(): void {
    const { modeling, tools } = this.session;
    if (modeling.isActive !== this.wasActive) {
      this.wasActive = modeling.isActive;
      if (modeling.isActive) tools.activate(tools.default);
      else this.displace(new Map());
    }
    this.displacements = new Map();
    this.update();
  }

  private displace(displacements: ReadonlyMap<string, Matrix4>): void {
    this.displacements = displacements;
    this.stage.world?.drawing.displace(displacements);
    this.lights.update(computeWorldFrame(this.stage), displacements);
  }

  private update(): void {
    this.manipulation.update();
    this.lights.update(computeWorldFrame(this.stage), this.displacements);
    this.stage.loop.invalidate();
  }

  /** Outlines the selected models in the scene. */
  private outlineSelection(): void {
    const { stage, session } = this;
    const { world } = stage;
    const links = world ? session.modeling.selectedNames.flatMap((name) => world.drawing.linksOf(name)) : [];
    session.selection.pick(world ? links.map((key) => ({ display: world.id, key })) : [], "replace");
    this.update();
  }
}
