import { Group, type Object3D, type Raycaster } from "three";
import type { DisplayData } from "../../connection/data";
import type { DescriptionRow, Hit, Interaction, ScenePointer, SelectionBox } from "../picking";
import type { Drawing, DrawingContext } from "./drawing";
import { InteractiveMarkersDrawing } from "./interactive-markers";
import { MarkersDrawing } from "./markers";

/** The prefixes of the keys of picked objects. */
const MARKER = "marker:";
const HANDLE = "handle:";

/** moveit_rviz_plugin/MotionPlanning: the scene and the states as markers, and the handles of the states. */
export class MotionPlanningDrawing implements Drawing {
  readonly root = new Group();
  private readonly markers: MarkersDrawing;
  private readonly handles: InteractiveMarkersDrawing;

  constructor(context: DrawingContext) {
    this.markers = new MarkersDrawing(context);
    this.handles = new InteractiveMarkersDrawing(context);
    this.root.add(this.markers.root, this.handles.root);
  }

  onPropertiesChanged(): void {
    this.markers.onPropertiesChanged();
    this.handles.onPropertiesChanged();
  }

  onDataChanged(data: DisplayData): void {
    const { content } = data;
    if (content.kind === "motion_planning_state") this.handles.setWrong(new Set(content.unreachable));
    else if (content.kind === "markers_changed") this.markers.onDataChanged(data);
    else this.handles.onDataChanged(data);
  }

  onDataRemoved(key: string | null): void {
    if (key === null) this.markers.onDataRemoved(); // single markers are removed by the content of the others
    this.handles.onDataRemoved(key);
  }

  update(): void {
    this.markers.update();
    this.handles.update();
  }

  isSettled(): boolean {
    return this.markers.isSettled() && this.handles.isSettled();
  }

  /** Returns the nearest handle, or else the nearest marker: handles are reached through the robot. */
  pick(ray: Raycaster): Hit | null {
    return addPrefix(HANDLE, this.handles.pick(ray)) ?? addPrefix(MARKER, this.markers.pick(ray));
  }

  pickBox(box: SelectionBox): readonly string[] {
    return this.markers.pickBox(box).map((key) => MARKER + key);
  }

  describe(key: string): DescriptionRow | null {
    return this.ownerOf(key).describe(key.slice(key.indexOf(":") + 1));
  }

  objectsOf(key: string): readonly Object3D[] {
    return this.ownerOf(key).objectsOf(key.slice(key.indexOf(":") + 1));
  }

  onInteractionChanged(interaction: Interaction): void {
    this.handles.onInteractionChanged(interaction);
  }

  onPointer(event: ScenePointer): boolean {
    if (event.hit?.key.startsWith(HANDLE) !== true) return false;
    return this.handles.onPointer({ ...event, hit: { ...event.hit, key: event.hit.key.slice(HANDLE.length) } });
  }

  inspect(): object {
    return { ...this.markers.inspect(), handles: this.handles.inspect() };
  }

  dispose(): void {
    this.markers.dispose();
    this.handles.dispose();
  }

  private ownerOf(key: string): MarkersDrawing | InteractiveMarkersDrawing {
    return key.startsWith(HANDLE) ? this.handles : this.markers;
  }
}

function addPrefix(prefix: string, hit: Hit | null): Hit | null {
  return hit && { ...hit, key: prefix + hit.key };
}
