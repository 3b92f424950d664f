import { Matrix4, Plane, Vector3 } from "three";
import type { Session } from "../state/session";
import { strings } from "../strings";
import { WorldDrawing } from "./displays/world";
import { modelOf } from "./displays/world-models";
import type { Stage } from "./stage";
import { ThinLines } from "./objects/thin-lines";
import type { ToolEvent } from "./tools/tool";

/** The tools that leave mouse events on models to other handlers. */
export const PASSIVE_TOOLS = ["rviz_default_plugins/Interact", "rviz_default_plugins/MoveCamera"];
/** The minimum time between two requests of a page, ms. */
const REQUEST_INTERVAL_MS = 50;
/** The force in N per m between the pulled point of a link and the mouse. */
const PULL_STIFFNESS_N_PER_M = 50;
const PULL_COLOR = "#ff2f6d";
/** Drawn last, to be visible through everything. */
const RENDER_ORDER = 1000;

/**
 * The drag in progress: a point of a link in the link's frame, its position at the start in the fixed frame, and the
 * plane of the drag.
 */
interface ModelGrab {
  readonly drawing: WorldDrawing;
  readonly link: string;
  readonly point: Vector3;
  readonly startPosition: Vector3;
  readonly plane: Plane;
  readonly isPull: boolean;
  lastSentMs: number;
  offset: Vector3;
  /** The position of the mouse in the fixed frame during a pull. */
  readonly pointerPosition: Vector3;
  /** The timer that repeats the force while the mouse rests; 0 for none. */
  timer: number;
}

/**
 * Handles the mouse on models of a simulated world: Ctrl moves a model along the ground, Ctrl and Shift pull it with a
 * force, and a right click opens its menu.
 */
export class WorldHandling {
  private currentGrab: ModelGrab | null = null;
  /** The line from the pulled point to the mouse. */
  private readonly line = new ThinLines();

  constructor(
    private readonly stage: Stage,
    private readonly session: Session,
  ) {
    this.line.setStyle(PULL_COLOR, 1);
    this.line.root.material.depthTest = false;
    this.line.root.renderOrder = RENDER_ORDER;
    stage.viewport.scene.add(this.line.root);
    session.simulation.findFreePosition = () => stage.world?.drawing.findFreePosition() ?? [0, 0, 0];
  }

  /** Handles an event; returns false if it is left to the active tool. */
  onPointer(event: ToolEvent): boolean {
    if (this.currentGrab) {
      if (event.type === "move" && event.isLeftDown) this.drag(this.currentGrab, event);
      else if (event.type === "up" && !event.isLeftDown) this.release(this.currentGrab);
      return true;
    }
    const { simulation, modeling, tools } = this.session;
    if (!simulation.isPresent || modeling.isActive || (tools.current && !PASSIVE_TOOLS.includes(tools.current.cls))) return false;
    if (event.type === "down" && event.button === "left" && event.isCtrlDown) return this.grab(event);
    if (event.type === "up" && event.button === "right" && event.isClick) this.openMenu(event);
    return false;
  }

  private grab(event: ToolEvent): boolean {
    const picked = this.findLinkAt(event);
    const camera = this.stage.viewport.camera;
    if (!picked?.matrix) return false;
    const { drawing, link, point: position, matrix } = picked;
    const normal = event.isShiftDown ? camera.getWorldDirection(new Vector3()) : new Vector3(0, 0, 1);
    const plane = new Plane().setFromNormalAndCoplanarPoint(normal, position);
    const point = position.clone().applyMatrix4(matrix.clone().invert());
    this.currentGrab = {
      drawing,
      link,
      point,
      startPosition: position.clone(),
      plane,
      isPull: event.isShiftDown,
      lastSentMs: -Infinity,
      offset: new Vector3(),
      pointerPosition: position.clone(),
      timer: 0,
    };
    if (event.isShiftDown) this.currentGrab.timer = window.setInterval(() => this.repeatPull(), REQUEST_INTERVAL_MS);
    this.stage.viewport.canvas.style.cursor = "grabbing";
    if (!event.isShiftDown) this.session.simulation.drag(modelOf(link), [0, 0, 0], true);
    return true;
  }

  private drag(grab: ModelGrab, event: ToolEvent): void {
    const target = this.stage.picker.rayAt(event.x, event.y).ray.intersectPlane(grab.plane, new Vector3());
    if (!target) return;
    if (grab.isPull) {
      grab.pointerPosition.copy(target);
      return;
    }
    target.z = grab.startPosition.z; // keep the exact height, from which the intersection deviates
    grab.offset = target.sub(grab.startPosition);
    const now = performance.now();
    if (now - grab.lastSentMs < REQUEST_INTERVAL_MS) return;
    grab.lastSentMs = now;
    this.send(grab);
  }

  /** Pulls the grabbed point towards the mouse from their current positions. */
  private repeatPull(): void {
    const grab = this.currentGrab;
    const matrix = grab?.drawing.poseOf(grab.link);
    if (!grab || !matrix) return;
    const start = grab.point.clone().applyMatrix4(matrix);
    grab.offset = grab.pointerPosition.clone().sub(start);
    this.line.setSegments(new Float32Array([...start.toArray(), ...grab.pointerPosition.toArray()]));
    this.stage.loop.invalidate();
    this.send(grab);
  }

  private release(grab: ModelGrab): void {
    if (!grab.isPull) this.send(grab);
    clearInterval(grab.timer);
    this.line.setSegments(new Float32Array(0));
    this.stage.loop.invalidate();
    this.currentGrab = null;
    this.stage.viewport.canvas.style.cursor = "default";
  }

  private send({ drawing, link, point, offset, isPull }: ModelGrab): void {
    const { simulation } = this.session;
    const offsetInWorld = drawing.transformToWorld(offset);
    if (isPull) simulation.push(link, point.toArray(), offsetInWorld.multiplyScalar(PULL_STIFFNESS_N_PER_M).toArray());
    else simulation.drag(modelOf(link), offsetInWorld.toArray(), false);
  }

  private openMenu(event: ToolEvent): void {
    const picked = this.findLinkAt(event);
    const { simulation, view, frames, sceneMenu } = this.session;
    const texts = strings.simulation;
    const point = picked?.point ?? this.stage.picker.groundAt(event.x, event.y);
    const coordinates = point instanceof Vector3 ? point.toArray() : point;
    if (!coordinates) return;
    const choices = [{ label: texts.spawnHere, run: () => simulation.spawnRequested.emit(picked ? picked.drawing.pointToWorld(coordinates) : coordinates) }];
    if (picked) {
      const model = modelOf(picked.link);
      const frame = picked.link.split("::").at(-1) ?? "";
      if (frames.hasPose(frames.rowOf(frame))) choices.push({ label: texts.follow(frame), run: () => view.setProperty("Target Frame", frame) });
      choices.push({ label: texts.remove(model), run: () => simulation.remove(model) });
    }
    sceneMenu.emit({ x: event.x, y: event.y, choices });
  }

  /** Returns the link of a world under the pointer. */
  private findLinkAt(event: ToolEvent): { drawing: WorldDrawing; link: string; point: Vector3; matrix: Matrix4 | null } | null {
    const picked = this.stage.picker.objectAt(event.x, event.y);
    if (!(picked?.drawing instanceof WorldDrawing)) return null;
    const { key, point } = picked.hit;
    return { drawing: picked.drawing, link: key, point: point.clone(), matrix: picked.drawing.poseOf(key) };
  }
}
