import { MeshoptSimplifier } from "meshoptimizer/simplifier";
import { createLodMesh, type LodMesh, type Triangles } from "./lod-mesh";

/** The page's request: an LOD mesh for each piece of a mesh. */
export interface LodMeshRequest {
  readonly id: number;
  readonly pieces: readonly Triangles[];
}

/** The answer; `lodMeshes` is null if they could not be computed. */
export interface LodMeshResponse {
  readonly id: number;
  readonly lodMeshes: readonly LodMesh[] | null;
}

/** The worker's global scope, which TypeScript's DOM types do not cover. */
const workerScope = globalThis as unknown as {
  onmessage: ((event: MessageEvent<LodMeshRequest>) => void) | null;
  postMessage: (response: LodMeshResponse, transfer: Transferable[]) => void;
};

workerScope.onmessage = ({ data: { id, pieces } }): void => {
  void MeshoptSimplifier.ready.then(() => {
    const lodMeshes = pieces.map((piece) => createLodMesh(piece, MeshoptSimplifier));
    const buffers = lodMeshes.flatMap(({ positions, normals, levels }) => {
      return [positions.buffer, normals.buffer, ...levels.map(({ index }) => index.buffer)];
    });
    workerScope.postMessage({ id, lodMeshes }, [...new Set(buffers)]);
  }).catch(() => workerScope.postMessage({ id, lodMeshes: null }, []));
};
