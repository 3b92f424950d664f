import { Box3, Group, Matrix4, Vector3, type Object3D, type Raycaster } from "three";
import type { DisplayData } from "../../connection/data";
import type { MarkerShape } from "../../protocol";
import { describeNumbers, describePose } from "../described-pose";
import { createMarkerObject, type MarkerObject } from "../markers/marker-object";
import { isSolid, SolidMarkers, createMarkerSurfaces } from "../markers/solid-markers";
import type { DescriptionRow, Hit, SelectionBox } from "../picking";
import { readFramePose, setPoseMatrix } from "../pose";
import type { Drawing, DrawingContext } from "./drawing";

interface MarkerEntry {
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
  private readonly entries = new Map<string, MarkerEntry>();
  private hiddenNamespaces = new Set<string>();
  private areSolidsStale = false;
  /** Objects for outlining the markers that are drawn in batches; nothing else draws these objects. */
  private readonly outlines = new Map<string, readonly Object3D[]>();

  constructor(private readonly context: DrawingContext) {
    this.onPropertiesChanged();
  }

  onPropertiesChanged(): void {
    const checkBoxes = this.context.display.rows.find("Namespaces")?.children ?? [];
    this.hiddenNamespaces = new Set(checkBoxes.filter((row) => row.value === false).map((row) => row.name));
    this.areSolidsStale = true;
  }

  onDataChanged({ content }: DisplayData): void {
    if (content.kind !== "markers_changed") return;
    if (content.everything) this.onDataRemoved();
    for (const id of content.removed_ids) this.remove(id);
    for (const marker of content.markers) this.show(marker);
    this.areSolidsStale = true;
  }

  onDataRemoved(): void {
    for (const id of [...this.entries.keys()]) this.remove(id);
    this.areSolidsStale = true;
  }

  update(): void {
    this.forgetOutlines();
    const pose = new Matrix4();
    let isStale = this.areSolidsStale;
    for (const { marker, object, pose: localPose } of this.entries.values()) {
      if (!object) {
        isStale ||= marker.frame !== "";
        continue;
      }
      const hasPose = this.computePose(marker, localPose, pose);
      object.root.visible = hasPose && !this.hiddenNamespaces.has(marker.namespace);
      if (hasPose) pose.decompose(object.root.position, object.root.quaternion, new Vector3());
    }
    if (isStale) this.arrangeSolids();
  }

  isSettled(): boolean {
    return [...this.entries.values()].every(({ object }) => object?.isSettled ?? true);
  }

  pick(ray: Raycaster): Hit | null {
    let nearestHit: Hit | null = null;
    for (const [key, entry] of this.entries) {
      if (this.hiddenNamespaces.has(entry.marker.namespace)) continue;
      const [hit] = ray.intersectObjects(this.surfacesOf(entry), true);
      if (hit && (nearestHit === null || hit.distance < nearestHit.distance)) {
        nearestHit = { key, distance: hit.distance, point: hit.point };
      }
    }
    return nearestHit;
  }

  pickBox(box: SelectionBox): readonly string[] {
    return [...this.entries]
      .filter(([, entry]) => this.surfacesOf(entry).some((object) => box.hasObject(object)))
      .map(([key]) => key);
  }

  describe(key: string): DescriptionRow | null {
    const entry = this.entries.get(key);
    if (!entry) return null;
    const { marker } = entry;
    const [x = 0, y = 0, z = 0] = marker.scale;
    const [r = 0, g = 0, b = 0, a = 0] = marker.color;
    return {
      name: `Marker ${marker.id}`,
      children: [
        ...describePose(entry.pose),
        describeNumbers("Scale", { X: x, Y: y, Z: z }),
        describeNumbers("Color", { R: r, G: g, B: b, A: a }),
      ],
    };
  }

  objectsOf(key: string): readonly Object3D[] {
    const entry = this.entries.get(key);
    if (!entry) return [];
    if (entry.object) return [entry.object.root];
    let outlines = this.outlines.get(key);
    if (!outlines) {
      outlines = this.createSurfaces(entry);
      for (const object of outlines) {
        object.layers.disableAll();
        this.root.add(object);
      }
      this.outlines.set(key, outlines);
    }
    return outlines;
  }

  inspect(): object {
    const box = new Box3();
    this.solids?.expandBox(box);
    for (const { object } of this.entries.values()) if (object?.root.visible === true) box.expandByObject(object.root);
    const shapes: Record<string, string> = {};
    for (const [id, { marker }] of this.entries) if (!this.hiddenNamespaces.has(marker.namespace)) shapes[id] = marker.shape;
    return { markers: shapes, bounds: box.isEmpty() ? null : [box.min.toArray(), box.max.toArray()] };
  }

  dispose(): void {
    this.onDataRemoved();
    this.solids?.dispose();
  }

  private forgetOutlines(): void {
    for (const object of [...this.outlines.values()].flat()) object.removeFromParent();
    this.outlines.clear();
  }

  /** Returns the surfaces that a ray can hit. */
  private surfacesOf(entry: MarkerEntry): Object3D[] {
    if (entry.object) return [entry.object.root];
    if (entry.marker.frame !== "") return this.createSurfaces(entry); // it moves
    return (entry.surfaces ??= this.createSurfaces(entry));
  }

  private createSurfaces({ marker, pose: localPose }: MarkerEntry): Object3D[] {
    const pose = new Matrix4();
    return this.computePose(marker, localPose, pose) ? createMarkerSurfaces(marker, pose) : [];
  }

  private show(marker: MarkerShape): void {
    const pose = setPoseMatrix(marker.pose, new Matrix4());
    const previous = this.entries.get(marker.id);
    if (previous?.object && hasSameMesh(previous.marker, marker)) {
      this.entries.set(marker.id, { marker, pose, object: previous.object, surfaces: null });
      return;
    }
    this.remove(marker.id);
    const object = isSolid(marker.shape) ? null : this.createObject(marker);
    this.entries.set(marker.id, { marker, pose, object, surfaces: null });
  }

  private createObject(marker: MarkerShape): MarkerObject {
    const { meshes, invalidate, session, display } = this.context;
    const object = createMarkerObject(marker, meshes, (problem) => {
      const url = marker.mesh?.url ?? marker.texture ?? "";
      session.connection.send({ type: "mesh_status", display: display.id, link: marker.id, url, error: problem });
      invalidate();
    });
    this.root.add(object.root);
    return object;
  }

  private remove(id: string): void {
    const entry = this.entries.get(id);
    entry?.object?.root.removeFromParent();
    entry?.object?.dispose();
    this.entries.delete(id);
  }

  /** Computes the marker's pose in the fixed frame; returns false if its frame has no transform. */
  private computePose(marker: MarkerShape, localPose: Matrix4, pose: Matrix4): boolean {
    if (marker.frame === "") {
      pose.copy(localPose);
      return true;
    }
    const { frames, displays } = this.context.session;
    if (marker.frame === displays.fixedFrame) pose.identity();
    else if (!readFramePose(frames, frames.rowOf(marker.frame), pose)) return false;
    pose.multiply(localPose);
    return true;
  }

  private arrangeSolids(): void {
    this.areSolidsStale = false;
    this.solids?.begin();
    for (const { marker, object, pose: localPose } of this.entries.values()) {
      if (object || this.hiddenNamespaces.has(marker.namespace)) continue;
      const pose = new Matrix4();
      if (this.computePose(marker, localPose, pose)) (this.solids ??= new SolidMarkers(this.root)).add(marker, pose);
    }
    this.solids?.end();
  }
}

/** Whether a mesh marker only moved, so that its mesh need not be loaded again. */
function hasSameMesh(first: MarkerShape, second: MarkerShape): boolean {
  const file = first.mesh?.url ?? null;
  return (
    file !== null &&
    first.shape === "mesh" &&
    second.shape === "mesh" &&
    file === second.mesh?.url &&
    first.mesh?.embedded === second.mesh.embedded &&
    String([first.scale, first.color]) === String([second.scale, second.color])
  );
}
