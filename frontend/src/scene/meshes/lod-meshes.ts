import type { BufferGeometry } from "three";
import type { LodMesh, Triangles } from "./lod-mesh";
import type { LodMeshResponse, LodMeshRequest } from "./lod-mesh-worker";

/** Larger meshes are not copied to a worker. */
const MAX_CORNER_COUNT = 9_000_000;

/** The part of `Worker` that the page uses for LOD meshes. */
export interface LodMeshWorker {
  onmessage: ((event: MessageEvent<LodMeshResponse>) => void) | null;
  onerror: ((event: ErrorEvent) => void) | null;
  postMessage(request: LodMeshRequest, transfer: Transferable[]): void;
}

/** Computes LOD meshes on demand; the worker is loaded with the first request. */
export class LodMeshes {
  private worker: LodMeshWorker | null = null;
  private readonly results = new WeakMap<BufferGeometry, readonly LodMesh[] | "waits" | "none">();
  private readonly requests = new Map<number, BufferGeometry>();
  private requestCount = 0;

  constructor(private readonly createWorker: () => LodMeshWorker) {}

  /**
   * Returns the LOD meshes of a geometry, one for each group or one for all of it; null until they are computed, empty
   * if there are none.
   */
  getOrRequest(geometry: BufferGeometry): readonly LodMesh[] | null {
    const existing = this.results.get(geometry);
    if (existing === undefined) this.request(geometry);
    return existing === undefined || existing === "waits" ? null : existing === "none" ? [] : existing;
  }

  private request(geometry: BufferGeometry): void {
    const pieces = copyPieces(geometry);
    this.results.set(geometry, pieces ? "waits" : "none");
    if (!pieces) return;
    this.worker ??= this.startWorker();
    this.requestCount += 1;
    this.requests.set(this.requestCount, geometry);
    const arrays = pieces.flatMap(({ positions, normals, index }) => [positions, normals, ...(index ? [index] : [])]);
    this.worker.postMessage({ id: this.requestCount, pieces }, [...new Set(arrays.map(({ buffer }) => buffer as ArrayBuffer))]);
  }

  private startWorker(): LodMeshWorker {
    const worker = this.createWorker();
    worker.onmessage = ({ data: { id, lodMeshes } }) => this.onResponse(id, lodMeshes);
    // If the browser does not run the worker, everything is drawn in full.
    worker.onerror = () => {
      for (const id of [...this.requests.keys()]) this.onResponse(id, null);
    };
    return worker;
  }

  private onResponse(id: number, lodMeshes: readonly LodMesh[] | null): void {
    const geometry = this.requests.get(id);
    this.requests.delete(id);
    if (geometry) this.results.set(geometry, lodMeshes ?? "none");
  }
}

/**
 * Returns copies of the triangles of each group; null if there are too many, or their attributes are not plain float
 * arrays.
 */
function copyPieces(geometry: BufferGeometry): Triangles[] | null {
  const [position, normal] = [geometry.getAttribute("position"), geometry.getAttribute("normal")];
  const cornerCount = geometry.index?.count ?? position.count;
  const isPlain = [position, normal].every((attribute) => attribute.itemSize === 3 && attribute.array instanceof Float32Array && !("data" in attribute));
  if (!isPlain || cornerCount > MAX_CORNER_COUNT || cornerCount === 0) return null;
  const index = geometry.index ? Uint32Array.from(geometry.index.array) : null;
  const [positions, normals] = [position.array as Float32Array, normal.array as Float32Array];
  const groups = geometry.groups.length > 0 ? geometry.groups : [{ start: 0, count: cornerCount }];
  return groups.map(({ start, count }) => {
    const end = Math.min(start + count, cornerCount);
    if (index) return { positions: positions.slice(), normals: normals.slice(), index: index.slice(start, end) };
    return { positions: positions.slice(3 * start, 3 * end), normals: normals.slice(3 * start, 3 * end), index: null };
  });
}
