import type { BufferGeometry } from "three";
import type { StandIn, Triangles } from "./stand-in";
import type { StandInAnswer, StandInRequest } from "./stand-in-worker";

/** Larger meshes are not copied to a worker. */
const MAX_CORNERS = 9_000_000;

/** The part of `Worker` that the page uses for stand-ins. */
export interface StandInWorker {
  onmessage: ((event: MessageEvent<StandInAnswer>) => void) | null;
  onerror: ((event: ErrorEvent) => void) | null;
  postMessage(request: StandInRequest, transfer: Transferable[]): void;
}

/** Computes stand-ins of meshes on demand; the worker is loaded with the first request. */
export class StandIns {
  private worker: StandInWorker | null = null;
  private readonly results = new WeakMap<BufferGeometry, readonly StandIn[] | "waits" | "none">();
  private readonly requests = new Map<number, BufferGeometry>();
  private count = 0;

  constructor(private readonly start: () => StandInWorker) {}

  /**
   * Returns the stand-ins of a geometry, one for each group or one for all of it; null until they are computed, empty
   * if there are none.
   */
  standInsOf(geometry: BufferGeometry): readonly StandIn[] | null {
    const existing = this.results.get(geometry);
    if (existing === undefined) this.request(geometry);
    return existing === undefined || existing === "waits" ? null : existing === "none" ? [] : existing;
  }

  private request(geometry: BufferGeometry): void {
    const pieces = piecesOf(geometry);
    this.results.set(geometry, pieces ? "waits" : "none");
    if (!pieces) return;
    this.worker ??= this.startWorker();
    this.count += 1;
    this.requests.set(this.count, geometry);
    const arrays = pieces.flatMap(({ positions, normals, index }) => [positions, normals, ...(index ? [index] : [])]);
    this.worker.postMessage({ id: this.count, pieces }, [...new Set(arrays.map(({ buffer }) => buffer as ArrayBuffer))]);
  }

  private startWorker(): StandInWorker {
    const worker = this.start();
    worker.onmessage = ({ data: { id, standIns } }) => this.onAnswer(id, standIns);
    // If the browser does not run the worker, everything is drawn in full.
    worker.onerror = () => {
      for (const id of [...this.requests.keys()]) this.onAnswer(id, null);
    };
    return worker;
  }

  private onAnswer(id: number, standIns: readonly StandIn[] | null): void {
    const geometry = this.requests.get(id);
    this.requests.delete(id);
    if (geometry) this.results.set(geometry, standIns ?? "none");
  }
}

/**
 * Returns copies of the triangles of each group; null if there are too many, or their attributes are not plain float
 * arrays.
 */
function piecesOf(geometry: BufferGeometry): Triangles[] | null {
  const [position, normal] = [geometry.getAttribute("position"), geometry.getAttribute("normal")];
  const corners = geometry.index?.count ?? position.count;
  const isPlain = [position, normal].every((attribute) => attribute.itemSize === 3 && attribute.array instanceof Float32Array && !("data" in attribute));
  if (!isPlain || corners > MAX_CORNERS || corners === 0) return null;
  const index = geometry.index ? Uint32Array.from(geometry.index.array) : null;
  const [positions, normals] = [position.array as Float32Array, normal.array as Float32Array];
  const groups = geometry.groups.length > 0 ? geometry.groups : [{ start: 0, count: corners }];
  return groups.map(({ start, count }) => {
    const end = Math.min(start + count, corners);
    if (index) return { positions: positions.slice(), normals: normals.slice(), index: index.slice(start, end) };
    return { positions: positions.slice(3 * start, 3 * end), normals: normals.slice(3 * start, 3 * end), index: null };
  });
}
