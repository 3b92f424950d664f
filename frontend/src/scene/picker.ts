import { Box3, Raycaster, Vector2 } from "three";
import type { Session } from "../state/session";
import type { SelectedItem, SelectionMode } from "../state/selection";
import { add, scale, type Bounds, type Vector } from "../state/views/vector";
import { DepthMap } from "./depth-map";
import { boundsOf } from "./initial-view";
import type { Drawing } from "./displays/drawing";
import { PICKABLE_LAYER } from "./layers";
import type { DescriptionRow, Hit } from "./picking";
import { ScreenBox } from "./selection-box";
import type { Viewport } from "./viewport";

/** An object of a display under the pointer. */
export interface PickedObject {
  display: string;
  drawing: Drawing;
  hit: Hit;
}

/** Finds objects at positions on the canvas, in pixels from its upper left corner. */
export class Picker {
  constructor(
    private readonly viewport: Viewport,
    private readonly session: Session,
    /** Returns the enabled displays with their drawings. */
    private readonly listDrawings: () => Iterable<readonly [string, Drawing]>,
  ) {}

  /** Returns the drawing of an enabled display. */
  drawingOf(display: string): Drawing | undefined {
    for (const [id, drawing] of this.listDrawings()) if (id === display) return drawing;
    return undefined;
  }

  /** Returns the ray from the camera through a position. */
  rayAt(x: number, y: number): Raycaster {
    this.viewport.aim(this.session.view);
    const ray = new Raycaster();
    ray.layers.enable(PICKABLE_LAYER);
    ray.setFromCamera(this.toDeviceCoordinates(x, y), this.viewport.camera);
    return ray;
  }

  /** Returns the nearest object at a position. */
  objectAt(x: number, y: number): PickedObject | null {
    return this.pickAlongRay(this.rayAt(x, y));
  }

  pickAlongRay(ray: Raycaster): PickedObject | null {
    let nearestObject: PickedObject | null = null;
    for (const [display, drawing] of this.listDrawings()) {
      const hit = drawing.pick?.(ray);
      if (hit && (nearestObject === null || hit.distance < nearestObject.hit.distance)) nearestObject = { display, drawing, hit };
    }
    return nearestObject;
  }

  /** Returns the point of the nearest object at a position, in the fixed frame. */
  pointAt(x: number, y: number): Vector | null {
    const picked = this.objectAt(x, y);
    return picked && [picked.hit.point.x, picked.hit.point.y, picked.hit.point.z];
  }

  /** Returns the point of the plane z = 0 of the fixed frame at a position. */
  groundAt(x: number, y: number): Vector | null {
    const { origin, direction } = this.rayAt(x, y).ray;
    const distance = -origin.z / direction.z;
    if (!Number.isFinite(distance) || distance < 0) return null;
    return [origin.x + direction.x * distance, origin.y + direction.y * distance, 0];
  }

  /** Selects the nearest object at a position, or clears the selection. */
  selectAt(x: number, y: number, mode: SelectionMode = "replace"): void {
    const picked = this.objectAt(x, y);
    const isSelectable = picked && !picked.hit.isGround;
    this.session.selection.pick(isSelectable ? [{ display: picked.display, key: picked.hit.key }] : [], mode);
  }

  /** Selects all visible objects in the rectangle between two positions. */
  selectBox(start: Vector2, end: Vector2, mode: SelectionMode): void {
    this.viewport.aim(this.session.view);
    const [firstCorner, secondCorner] = [this.toDeviceCoordinates(start.x, start.y), this.toDeviceCoordinates(end.x, end.y)];
    const depths = new DepthMap(this.viewport);
    const isVisible = depths.isVisible.bind(depths);
    const box = new ScreenBox(this.viewport.camera, firstCorner.clone().min(secondCorner), firstCorner.clone().max(secondCorner), isVisible);
    const items: SelectedItem[] = [];
    for (const [display, drawing] of this.listDrawings()) {
      for (const key of drawing.pickBox?.(box) ?? []) items.push({ display, key });
    }
    this.session.selection.pick(items, mode);
  }

  /** Returns the rows of the Selection panel for an object; null if the object is no longer drawn. */
  describe(item: SelectedItem): DescriptionRow | null {
    for (const [display, drawing] of this.listDrawings()) {
      if (display === item.display) return drawing.describe?.(item.key) ?? null;
    }
    return null;
  }

  /** Returns the center of the selection, or of all selectable objects if nothing is selected. */
  centerOfSelection(): Vector | null {
    const bounds = this.computeSelectionBounds() ?? this.computeAllBounds();
    return bounds && scale(add(bounds.min, bounds.max), 0.5);
  }

  /** Returns the bounding box of all selectable objects in the fixed frame. */
  computeAllBounds(): Bounds | null {
    const box = new Box3();
    for (const [, drawing] of this.listDrawings()) if (drawing.pick) box.expandByObject(drawing.root);
    return boundsOf(box);
  }

  /** Returns the bounding box of the selection in the fixed frame; null if nothing is selected. */
  computeSelectionBounds(): Bounds | null {
    const box = new Box3();
    for (const [display, drawing] of this.listDrawings()) {
      for (const item of this.session.selection.items) {
        if (item.display !== display) continue;
        const objects = drawing.objectsOf?.(item.key) ?? [];
        for (const object of objects) box.expandByObject(object);
        const position = objects.length === 0 ? drawing.positionOf?.(item.key) : null;
        if (position) box.expandByPoint(position);
      }
    }
    return boundsOf(box);
  }

  private toDeviceCoordinates(x: number, y: number): Vector2 {
    const { clientWidth, clientHeight } = this.viewport.canvas;
    return new Vector2((x / clientWidth) * 2 - 1, 1 - (y / clientHeight) * 2);
  }
}
