import { Box3, Group, Matrix4, Vector3, type Object3D, type Raycaster } from "three";
import type { DisplayData } from "../../connection/data";
import type { MarkerShape } from "../../protocol";
import { describedNumbers, describedPose } from "../described-pose";
import { makeMarkerObject, type MarkerObject } from "../markers/marker-object";
import { isSolid, SolidMarkers, surfacesOf } from "../markers/solid-markers";
import type { DescriptionRow, Hit, SelectionBox } from "../picking";
import { framePose, poseMatrix } from "../pose";
import type { Drawing, DrawingContext } from "./drawing";

interface ShownMarker {
  marker: MarkerShape;
  /** The pose of the marker in its frame, or in the fixed frame. */
  pose: Matrix4;
  object: MarkerObject | null;
  /** The surfaces for ray tests of a marker that is drawn in a batch; cached, because every mouse move tests them. */
  surfaces: Object3D[] | null;
}

/** rviz_default_plugins/Marker and MarkerArray */
export class MarkersDrawing implements Drawing {
  readonly root = new Group();
  /** Null until a marker needs it: of a hundred such displays in a file, few ever receive one. */
  private solids: SolidMarkers | null = null;
  private readonly shown = new Map<string, ShownMarker>();
  private hidden = new Set<string>();
  private areSolidsStale = false;
  /** Objects for outlining the markers that are drawn in batches; nothing else draws these objects. */
  private readonly outlined = new Map<string, readonly Object3D[]>();

  constructor(private readonly context: DrawingContext) {
    this.propertiesChanged();
  }

  propertiesChanged(): void {
    const boxes = this.context.display.rows.find("Namespaces")?.children ?? [];
    this.hidden = new Set(boxes.filter((row) => row.value === false).map((row) => row.name));
    this.areSolidsStale = true;
  }

  dataChanged({ content }: DisplayData): void {
    if (content.kind !== "markers_changed") return;
    if (content.everything) this.dataForgotten();
    for (const id of content.gone) this.remove(id);
    for (const marker of content.markers) this.show(marker);
    this.areSolidsStale = true;
  }

  dataForgotten(): void {
    for (const id of [...this.shown.keys()]) this.remove(id);
    this.areSolidsStale = true;
  }

  update(): void {
    this.forgetOutlines();
    const pose = new Matrix4();
    let moved = this.areSolidsStale;
    for (const { marker, object, pose: own } of this.shown.values()) {
      if (!object) {
        moved ||= marker.frame !== "";
        continue;
      }
      const placed = this.place(marker, own, pose);
      object.root.visible = placed && !this.hidden.has(marker.namespace);
      if (placed) pose.decompose(object.root.position, object.root.quaternion, new Vector3());
    }
    if (moved) this.arrangeSolids();
  }

  settled(): boolean {
    return [...this.shown.values()].every(({ object }) => object?.settled ?? true);
  }

  pick(ray: Raycaster): Hit | null {
    let best: Hit | null = null;
    for (const [key, shown] of this.shown) {
      if (this.hidden.has(shown.marker.namespace)) continue;
      const [hit] = ray.intersectObjects(this.surfacesOf(shown), true);
      if (hit && (best === null || hit.distance < best.distance)) {
        best = { key, distance: hit.distance, point: hit.point };
      }
    }
    return best;
  }

  pickBox(box: SelectionBox): readonly string[] {
    return [...this.shown]
      .filter(([, shown]) => this.surfacesOf(shown).some((object) => box.hasObject(object)))
      .map(([key]) => key);
  }

  describe(key: string): DescriptionRow | null {
    const shown = this.shown.get(key);
    if (!shown) return null;
    const { marker } = shown;
    const [x = 0, y = 0, z = 0] = marker.scale;
    const [r = 0, g = 0, b = 0, a = 0] = marker.color;
    return {
      name: `Marker ${marker.id}`,
      children: [
        ...describedPose(shown.pose),
        describedNumbers("Scale", { X: x, Y: y, Z: z }),
        describedNumbers("Color", { R: r, G: g, B: b, A: a }),
      ],
    };
  }

  objectsOf(key: string): readonly Object3D[] {
    const shown = this.shown.get(key);
    if (!shown) return [];
    if (shown.object) return [shown.object.root];
    let outlined = this.outlined.get(key);
    if (!outlined) {
      outlined = this.makeSurfaces(shown);
      for (const each of outlined) {
        each.layers.disableAll();
        this.root.add(each);
      }
      this.outlined.set(key, outlined);
    }
    return outlined;
  }

  inspect(): object {
    const box = new Box3();
    this.solids?.expandBox(box);
    for (const { object } of this.shown.values()) if (object?.root.visible === true) box.expandByObject(object.root);
    const shapes: Record<string, string> = {};
    for (const [id, { marker }] of this.shown) if (!this.hidden.has(marker.namespace)) shapes[id] = marker.shape;
    return { markers: shapes, bounds: box.isEmpty() ? null : [box.min.toArray(), box.max.toArray()] };
  }

  dispose(): void {
    this.dataForgotten();
    this.solids?.dispose();
  }

  private forgetOutlines(): void {
    for (const each of [...this.outlined.values()].flat()) each.removeFromParent();
    this.outlined.clear();
  }

  /** Returns the surfaces that a ray can hit. */
  private surfacesOf(shown: ShownMarker): Object3D[] {
    if (shown.object) return [shown.object.root];
    if (shown.marker.frame !== "") return this.makeSurfaces(shown); // it moves
    return (shown.surfaces ??= this.makeSurfaces(shown));
  }

  private makeSurfaces({ marker, pose: own }: ShownMarker): Object3D[] {
    const pose = new Matrix4();
    return this.place(marker, own, pose) ? surfacesOf(marker, pose) : [];
  }

  private show(marker: MarkerShape): void {
    const pose = poseMatrix(marker.pose, new Matrix4());
    const before = this.shown.get(marker.id);
    if (before?.object && hasSameMesh(before.marker, marker)) {
      this.shown.set(marker.id, { marker, pose, object: before.object, surfaces: null });
      return;
    }
    this.remove(marker.id);
    const object = isSolid(marker.shape) ? null : this.makeObject(marker);
    this.shown.set(marker.id, { marker, pose, object, surfaces: null });
  }

  private makeObject(marker: MarkerShape): MarkerObject {
    const { meshes, invalidate, session, display } = this.context;
    const object = makeMarkerObject(marker, meshes, (problem) => {
      const url = marker.mesh?.url ?? marker.texture ?? "";
      session.connection.send({ type: "mesh_status", display: display.id, link: marker.id, url, error: problem });
      invalidate();
    });
    this.root.add(object.root);
    return object;
  }

  private remove(id: string): void {
    const shown = this.shown.get(id);
    shown?.object?.root.removeFromParent();
    shown?.object?.dispose();
    this.shown.delete(id);
  }

  /** Computes the marker's pose in the fixed frame; returns false if its frame has no transform. */
  private place(marker: MarkerShape, own: Matrix4, pose: Matrix4): boolean {
    if (marker.frame === "") {
      pose.copy(own);
      return true;
    }
    const { frames, displays } = this.context.session;
    if (marker.frame === displays.fixedFrame) pose.identity();
    else if (!framePose(frames, frames.row(marker.frame), pose)) return false;
    pose.multiply(own);
    return true;
  }

  private arrangeSolids(): void {
    this.areSolidsStale = false;
    this.solids?.begin();
    for (const { marker, object, pose: own } of this.shown.values()) {
      if (object || this.hidden.has(marker.namespace)) continue;
      const pose = new Matrix4();
      if (this.place(marker, own, pose)) (this.solids ??= new SolidMarkers(this.root)).add(marker, pose);
    }
    this.solids?.end();
  }
}

/** Whether a mesh marker only moved, so that its mesh need not be loaded again. */
function hasSameMesh(one: MarkerShape, other: MarkerShape): boolean {
  const file = one.mesh?.url ?? null;
  return (
    file !== null &&
    one.shape === "mesh" &&
    other.shape === "mesh" &&
    file === other.mesh?.url &&
    one.mesh?.embedded === other.mesh.embedded &&
    String([one.scale, one.color]) === String([other.scale, other.color])
  );
}
