import type { Object3D } from "three";
import type { Session } from "../state/session";
import { FLASHING } from "./layers";
import { Outline } from "./outline";
import type { Viewport } from "./viewport";

const COLOR = 0xff9d3c;
const FILL = 0.55;
const DURATION_MS = 1600;
/** The time at full strength at the start, ms, because new meshes may take a moment to load. */
const FULL_MS = 600;

/** Highlights for a moment the links that an edit changed, or whose joints it moved. */
export class Flash {
  private readonly outline: Outline;
  private links: { display: string; names: ReadonlySet<string>; startMs: number }[] = [];

  /** @param objectsOf - returns the objects that draw a link of a display. */
  constructor(
    viewport: Viewport,
    session: Session,
    private readonly objectsOf: (display: string, link: string) => readonly Object3D[],
    private readonly invalidate: () => void,
  ) {
    this.outline = new Outline(viewport, { color: COLOR, layer: FLASHING, fill: FILL });
    session.description.edited.on(({ display, links, joints }) => {
      const movedLinks = joints.map((name) => session.focus.linkOf({ display, kind: "joint", name }));
      const names = new Set([...links, ...movedLinks.filter((name) => name !== undefined)]);
      this.links.push({ display, names, startMs: performance.now() });
      invalidate();
    });
  }

  /** Draws over the frame just rendered, and requests the next frame while the highlight lasts. */
  render(): void {
    if (this.links.length === 0) return;
    const now = performance.now();
    this.links = this.links.filter(({ startMs }) => now - startMs < DURATION_MS);
    const objects = this.links.flatMap(({ display, names }) => [...names].flatMap((name) => this.objectsOf(display, name)));
    const newestStart = Math.max(...this.links.map(({ startMs }) => startMs));
    this.outline.strength = Math.min(1, Math.max(0, (DURATION_MS - (now - newestStart)) / (DURATION_MS - FULL_MS)));
    this.outline.set(objects);
    this.outline.render();
    this.outline.set([]);
    this.invalidate();
  }
}
