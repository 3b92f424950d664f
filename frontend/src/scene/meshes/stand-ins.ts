import type { BufferGeometry } from "three";
import type { StandIn, Triangles } from "./stand-in";
import type { StandInAnswer, StandInRequest } from "./stand-in-worker";

/** Of larger meshes no copies are sent to a worker. */
const MOST_CORNERS = 9_000_000;

/** The `Worker` that makes stand-ins, as the page uses it. */
export interface StandInWorker {
  onmessage: ((event: MessageEvent<StandInAnswer>) => void) | null;
  onerror: ((event: ErrorEvent) => void) | null;
  postMessage(request: StandInRequest, transfer: Transferable[]): void;
}

/** Has stand-ins made for meshes, once a caller asks. The worker is not even loaded before. */
export class StandIns {
  private worker: StandInWorker | null = null;
  private readonly made = new WeakMap<BufferGeometry, readonly StandIn[] | "waits" | "none">();
  private readonly asked = new Map<number, BufferGeometry>();
  private count = 0;

  constructor(private readonly start: () => StandInWorker) {}

  /** One for each group of a geometry, or for all of it; null: not yet. Empty where there is none. */
  of(geometry: BufferGeometry): readonly StandIn[] | null {
    const known = this.made.get(geometry);
    if (known === undefined) this.ask(geometry);
    return known === undefined || known === "waits" ? null : known === "none" ? [] : known;
  }

  private ask(geometry: BufferGeometry): void {
    const pieces = piecesOf(geometry);
    this.made.set(geometry, pieces ? "waits" : "none");
    if (!pieces) return;
    this.worker ??= this.begin();
    this.count += 1;
    this.asked.set(this.count, geometry);
    const arrays = pieces.flatMap(({ positions, normals, index }) => [positions, normals, ...(index ? [index] : [])]);
    this.worker.postMessage({ id: this.count, pieces }, [...new Set(arrays.map(({ buffer }) => buffer as ArrayBuffer))]);
  }

  private begin(): StandInWorker {
    const worker = this.start();
    worker.onmessage = ({ data: { id, standIns } }) => this.answered(id, standIns);
    // A browser that does not let it run: everything is drawn as it is.
    worker.onerror = () => {
      for (const id of [...this.asked.keys()]) this.answered(id, null);
    };
    return worker;
  }

  private answered(id: number, standIns: readonly StandIn[] | null): void {
    const geometry = this.asked.get(id);
    this.asked.delete(id);
    if (geometry) this.made.set(geometry, standIns ?? "none");
  }
}

/** Copies of the triangles of each group; null where they are too many or no plain triangles. */
function piecesOf(geometry: BufferGeometry): Triangles[] | null {
  const [position, normal] = [geometry.getAttribute("position"), geometry.getAttribute("normal")];
  const corners = geometry.index?.count ?? position.count;
  const isPlain = [position, normal].every((each) => each.itemSize === 3 && each.array instanceof Float32Array && !("data" in each));
  if (!isPlain || corners > MOST_CORNERS || corners === 0) return null;
  const all = geometry.index ? Uint32Array.from(geometry.index.array) : null;
  const [positions, normals] = [position.array as Float32Array, normal.array as Float32Array];
  const groups = geometry.groups.length > 0 ? geometry.groups : [{ start: 0, count: corners }];
  return groups.map(({ start, count }) => {
    const end = Math.min(start + count, corners);
    if (all) return { positions: positions.slice(), normals: normals.slice(), index: all.slice(start, end) };
    return { positions: positions.slice(3 * start, 3 * end), normals: normals.slice(3 * start, 3 * end), index: null };
  });
}
