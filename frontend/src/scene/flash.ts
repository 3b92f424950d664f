import type { Object3D } from "three";
import type { Session } from "../state/session";
import { FLASHING_LAYER } from "./layers";
import { Outline } from "./outline";
import type { Viewport } from "./viewport";

const FLASH_COLOR = 0xff9d3c;
const FILL_ALPHA = 0.55;
const DURATION_MS = 1600;
/** The time at full strength at the start, ms, because new meshes may still be loading. */
const FULL_STRENGTH_MS = 600;

/** Briefly highlights the links that an edit changed, or whose joints it moved. */
export class Flash {
  private readonly outline: Outline;
  private flashes: { display: string; names: ReadonlySet<string>; startMs: number }[] = [];

  /** @param objectsOf - returns the objects that draw a link of a display. */
  constructor(
    viewport: Viewport,
    session: Session,
    private readonly objectsOf: (display: string, link: string) => readonly Object3D[],
    private readonly invalidate: () => void,
  ) {
    this.outline = new Outline(viewport, { color: FLASH_COLOR, layer: FLASHING_LAYER, fill: FILL_ALPHA });
    session.description.edited.on(({ display, links, joints }) => {
      const movedLinks = joints.map((name) => session.focus.linkOf({ display, kind: "joint", name }));
      const names = new Set([...links, ...movedLinks.filter((name) => name !== undefined)]);
      this.flashes.push({ display, names, startMs: performance.now() });
      invalidate();
    });
  }

  /** Draws over the frame just rendered, and requests the next frame while the highlight lasts. */
  render(): void {
    if (this.flashes.length === 0) return;
    const now = performance.now();
    this.flashes = this.flashes.filter(({ startMs }) => now - startMs < DURATION_MS);
    const objects = this.flashes.flatMap(({ display, names }) => [...names].flatMap((name) => this.objectsOf(display, name)));
    const newestStart = Math.max(...this.flashes.map(({ startMs }) => startMs));
    this.outline.strength = Math.min(1, Math.max(0, (DURATION_MS - (now - newestStart)) / (DURATION_MS - FULL_STRENGTH_MS)));
    this.outline.set(objects);
    this.outline.render();
    this.outline.set([]);
    this.invalidate();
  }
}
