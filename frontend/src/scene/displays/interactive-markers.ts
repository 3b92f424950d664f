import { Box3, Group, Matrix4, type Object3D, type Raycaster } from "three";
import type { DisplayData } from "../../connection/data";
import type { MarkerMenuEntry } from "../../protocol";
import type { MenuChoice } from "../../state/scene-menu";
import { strings } from "../../strings";
import { describePose } from "../described-pose";
import type { ControlHandle } from "../interactive/control-handle";
import { MarkerHandle } from "../interactive/marker-handle";
import type { DescriptionRow, Hit, Interaction, ScenePointer } from "../picking";
import { setPoseMatrix } from "../pose";
import type { Drawing, DrawingContext } from "./drawing";

/** The minimum interval between the poses that are sent while a marker is dragged, ms. */
const FEEDBACK_INTERVAL_MS = 33;

/** rviz_default_plugins/InteractiveMarkers */
export class InteractiveMarkersDrawing implements Drawing {
  readonly root = new Group();
  private readonly markers = new Map<string, MarkerHandle>();
  private interaction: Interaction = { isEnabled: false, hidesOthers: false };
  private lastFeedbackMs = 0;

  constructor(private readonly context: DrawingContext) {}

  onPropertiesChanged(): void {
    // Properties are read in update().
  }

  onDataChanged(data: DisplayData): void {
    const { content } = data;
    if (content.kind === "interactive_marker_moved") {
      this.markers.get(content.name)?.setServerPose(data, content.pose);
    } else if (content.kind === "interactive_marker") {
      this.remove(content.name);
      const marker = new MarkerHandle(content, data, this.context.meshes, this.context.invalidate);
      this.markers.set(content.name, marker);
      this.root.add(marker.root);
    }
  }

  /** Marks the handles with these names as red, because their poses cannot be reached; others lose the mark. */
  setWrong(names: ReadonlySet<string>): void {
    for (const [name, marker] of this.markers) {
      for (const control of marker.controls) control.isWrong = names.has(name);
    }
  }

  onDataRemoved(key: string | null): void {
    if (key === null) for (const name of [...this.markers.keys()]) this.remove(name);
    else if (key.startsWith(MARKER_KEY_PREFIX)) this.remove(key.slice(MARKER_KEY_PREFIX.length));
  }

  update(): void {
    const { session, getCamera, display } = this.context;
    const isAnyHeld = [...this.markers.values()].some((marker) => marker.isHeld);
    for (const marker of this.markers.values()) {
      const isHidden = isAnyHeld && this.interaction.hidesOthers && !marker.isHeld;
      marker.update(session.frames, getCamera(), {
        showsDescriptions: display.rows.bool(true, "Show Descriptions"),
        showsAxes: display.rows.bool(false, "Show Axes"),
        showsAids: display.rows.bool(false, "Show Visual Aids"),
        isInteractive: this.interaction.isEnabled && !isHidden,
      });
    }
  }

  isSettled(): boolean {
    return [...this.markers.values()].every((marker) => marker.isSettled);
  }

  pick(ray: Raycaster): Hit | null {
    let nearestHit: Hit | null = null;
    for (const [name, marker] of this.markers) {
      const hit = marker.root.visible ? marker.findNearestHit(ray) : null;
      if (hit && (nearestHit === null || hit.distance < nearestHit.distance)) {
        nearestHit = { key: `${hit.control}/${name}`, distance: hit.distance, point: hit.point };
      }
    }
    return nearestHit;
  }

  describe(key: string): DescriptionRow | null {
    const picked = this.find(key);
    if (!picked) return null;
    return {
      name: `Interactive Marker ${picked.marker.shape.name}`,
      children: [
        ...describePose(setPoseMatrix(picked.marker.values, new Matrix4())),
        { name: "Control", value: picked.control.control.name },
      ],
    };
  }

  objectsOf(key: string): readonly Object3D[] {
    const picked = this.find(key);
    return picked ? [picked.control.root] : [];
  }

  onInteractionChanged(interaction: Interaction): void {
    this.interaction = { ...interaction };
    this.context.invalidate();
  }

  onPointer(event: ScenePointer): boolean {
    const picked = event.hit && this.find(event.hit.key);
    if (!event.hit || !picked) return false;
    const { marker, control } = picked;
    const { invalidate, getCamera } = this.context;
    switch (event.type) {
      case "enter":
      case "leave":
        control.isHighlighted = event.type === "enter";
        event.setCursor(event.type === "enter" ? "grab" : "");
        event.setHint(event.type === "enter" ? composeHint(control, marker.shape.menu.length > 0) : "");
        invalidate();
        return true;
      case "down":
        return this.onPointerDown(event, event.hit, marker, control);
      case "move":
        if (marker.followPointer(event, getCamera())) {
          this.sendPose(marker, control);
          invalidate();
        }
        return true;
      case "up":
        this.onPointerUp(event, marker, control);
        return true;
      case "wheel":
        return marker.isHeld;
    }
  }

  inspect(): object {
    return Object.fromEntries(
      [...this.markers].map(([name, marker]) => {
        const box = new Box3().setFromObject(marker.root);
        const bounds = [box.min.toArray(), box.max.toArray()];
        return [name, { pose: marker.values, controls: marker.controls.length, aided: marker.isAidShown, wrong: marker.controls.some((control) => control.isWrong), bounds }];
      }),
    );
  }

  dispose(): void {
    this.onDataRemoved(null);
  }

  private onPointerDown(event: ScenePointer, hit: Hit, marker: MarkerHandle, control: ControlHandle): boolean {
    const { menu } = marker.shape;
    if (menu.length > 0 && (event.button === "right" || control.control.mode === "menu")) {
      this.context.session.sceneMenu.emit({ x: event.x, y: event.y, choices: this.listChoices(marker, control, menu, 0) });
      return true;
    }
    if (event.button !== "left") return false;
    marker.grab(control, hit.point);
    this.send(marker, control, "mouse_down");
    event.setCursor("grabbing");
    return true;
  }

  private onPointerUp(event: ScenePointer, marker: MarkerHandle, control: ControlHandle): void {
    if (!marker.isHeld) return;
    marker.release();
    if (control.control.mode === "button") this.send(marker, control, "button_click");
    else if (control.control.mode !== "none") this.send(marker, control, "pose_update");
    this.send(marker, control, "mouse_up");
    event.setCursor("grab");
    this.context.invalidate();
  }

  private listChoices(
    marker: MarkerHandle,
    control: ControlHandle,
    menu: readonly MarkerMenuEntry[],
    parent: number,
  ): MenuChoice[] {
    return menu
      .filter((entry) => entry.parent === parent && entry.id !== parent)
      .map((entry) => {
        const choices = this.listChoices(marker, control, menu, entry.id);
        const run = (): void => {
          this.context.session.connection.send(marker.createFeedback(control, "menu_select", entry.id));
        };
        return { label: entry.title, ...(choices.length > 0 ? { choices } : { run }) };
      });
  }

  private sendPose(marker: MarkerHandle, control: ControlHandle): void {
    const now = performance.now();
    if (now - this.lastFeedbackMs < FEEDBACK_INTERVAL_MS) return;
    this.lastFeedbackMs = now;
    this.send(marker, control, "pose_update");
  }

  private send(marker: MarkerHandle, control: ControlHandle, event: Parameters<MarkerHandle["createFeedback"]>[1]): void {
    this.context.session.connection.send(marker.createFeedback(control, event));
  }

  private remove(name: string): void {
    this.markers.get(name)?.dispose();
    this.markers.delete(name);
  }

  private find(key: string): { marker: MarkerHandle; control: ControlHandle } | null {
    const slash = key.indexOf("/");
    const marker = this.markers.get(key.slice(slash + 1));
    const control = marker?.controls[Number(key.slice(0, slash))];
    return marker && control ? { marker, control } : null;
  }
}

const MARKER_KEY_PREFIX = "marker ";

function composeHint(control: ControlHandle, hasMenu: boolean): string {
  const texts = strings.interactive;
  const { mode, description } = control.control;
  const modeHint = mode === "none" ? "" : texts.modes[mode];
  return [description, modeHint, hasMenu && mode !== "menu" ? texts.menu : ""]
    .filter((part) => part !== "")
    .join(" ");
}
