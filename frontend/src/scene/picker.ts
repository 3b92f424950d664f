import { Box3, Raycaster, Vector2 } from "three";
import type { Session } from "../state/session";
import type { SelectedItem, SelectionMode } from "../state/selection";
import { add, scale, type Span, type Vector } from "../state/views/vector";
import { DepthMap } from "./depth-map";
import { spanOf } from "./first-look";
import type { Drawing } from "./displays/drawing";
import { TOUCHED } from "./layers";
import type { Described, Hit } from "./picking";
import { ScreenBox } from "./selection-box";
import type { Viewport } from "./viewport";

/** A thing of a display under the pointer. */
export interface Found {
  display: string;
  drawing: Drawing;
  hit: Hit;
}

/** Finds what is seen at a place of the canvas; places are pixels from its upper left corner. */
export class Picker {
  constructor(
    private readonly viewport: Viewport,
    private readonly session: Session,
    /** The enabled displays with their drawings. */
    private readonly drawings: () => Iterable<readonly [string, Drawing]>,
  ) {}

  /** The drawing of a display that is on. */
  drawing(display: string): Drawing | undefined {
    for (const [id, drawing] of this.drawings()) if (id === display) return drawing;
    return undefined;
  }

  /** The ray from the camera through a place. */
  rayAt(x: number, y: number): Raycaster {
    this.viewport.aim(this.session.view);
    const ray = new Raycaster();
    ray.layers.enable(TOUCHED);
    ray.setFromCamera(this.onScreen(x, y), this.viewport.camera);
    return ray;
  }

  /** The nearest thing at a place. */
  at(x: number, y: number): Found | null {
    return this.along(this.rayAt(x, y));
  }

  along(ray: Raycaster): Found | null {
    let best: Found | null = null;
    for (const [display, drawing] of this.drawings()) {
      const hit = drawing.pick?.(ray);
      if (hit && (best === null || hit.distance < best.hit.distance)) best = { display, drawing, hit };
    }
    return best;
  }

  /** The point of the nearest thing at a place, in the fixed frame. */
  pointAt(x: number, y: number): Vector | null {
    const found = this.at(x, y);
    return found && [found.hit.point.x, found.hit.point.y, found.hit.point.z];
  }

  /** The point of the plane z = 0 of the fixed frame at a place. */
  groundAt(x: number, y: number): Vector | null {
    const { origin, direction } = this.rayAt(x, y).ray;
    const distance = -origin.z / direction.z;
    if (!Number.isFinite(distance) || distance < 0) return null;
    return [origin.x + direction.x * distance, origin.y + direction.y * distance, 0];
  }

  /** Selects the nearest thing at a place, or nothing. */
  selectAt(x: number, y: number, mode: SelectionMode = "replace"): void {
    const found = this.at(x, y);
    const selected = found && !found.hit.isGround;
    this.session.selection.pick(selected ? [{ display: found.display, key: found.hit.key }] : [], mode);
  }

  /** Selects all visible things in the rectangle between two places. */
  selectBox(from: Vector2, to: Vector2, mode: SelectionMode): void {
    this.viewport.aim(this.session.view);
    const [a, b] = [this.onScreen(from.x, from.y), this.onScreen(to.x, to.y)];
    const depths = new DepthMap(this.viewport);
    const isSeen = depths.isSeen.bind(depths);
    const box = new ScreenBox(this.viewport.camera, a.clone().min(b), a.clone().max(b), isSeen);
    const items: SelectedItem[] = [];
    for (const [display, drawing] of this.drawings()) {
      for (const key of drawing.pickBox?.(box) ?? []) items.push({ display, key });
    }
    this.session.selection.pick(items, mode);
  }

  /** The rows of the Selection panel for a thing; null when it is not drawn any more. */
  describe(item: SelectedItem): Described | null {
    for (const [display, drawing] of this.drawings()) {
      if (display === item.display) return drawing.describe?.(item.key) ?? null;
    }
    return null;
  }

  /** The middle of the selection, or of all selectable things when nothing is selected. */
  middleOfSelection(): Vector | null {
    const span = this.boundsOfSelection() ?? this.boundsOfAll();
    return span && scale(add(span.min, span.max), 0.5);
  }

  /** The box around all that can be selected, in the fixed frame. */
  boundsOfAll(): Span | null {
    const box = new Box3();
    for (const [, drawing] of this.drawings()) if (drawing.pick) box.expandByObject(drawing.root);
    return spanOf(box);
  }

  /** The box around what is selected, in the fixed frame; null when nothing is. */
  boundsOfSelection(): Span | null {
    const box = new Box3();
    for (const [display, drawing] of this.drawings()) {
      for (const item of this.session.selection.items) {
        if (item.display !== display) continue;
        const objects = drawing.objectsOf?.(item.key) ?? [];
        for (const object of objects) box.expandByObject(object);
        const place = objects.length === 0 ? drawing.placeOf?.(item.key) : null;
        if (place) box.expandByPoint(place);
      }
    }
    return spanOf(box);
  }

  private onScreen(x: number, y: number): Vector2 {
    const { clientWidth, clientHeight } = this.viewport.canvas;
    return new Vector2((x / clientWidth) * 2 - 1, 1 - (y / clientHeight) * 2);
  }
}
