import { MeshoptSimplifier } from "meshoptimizer/simplifier";
import { createStandIn, type StandIn, type Triangles } from "./stand-in";

/** The page's request: a stand-in for each piece of a mesh. */
export interface StandInRequest {
  readonly id: number;
  readonly pieces: readonly Triangles[];
}

/** The answer; `standIns` is null if they could not be computed. */
export interface StandInAnswer {
  readonly id: number;
  readonly standIns: readonly StandIn[] | null;
}

/** The worker's global scope, which TypeScript's DOM types do not cover. */
const scope = globalThis as unknown as {
  onmessage: ((event: MessageEvent<StandInRequest>) => void) | null;
  postMessage: (answer: StandInAnswer, transfer: Transferable[]) => void;
};

scope.onmessage = ({ data: { id, pieces } }): void => {
  void MeshoptSimplifier.ready.then(() => {
    const standIns = pieces.map((piece) => createStandIn(piece, MeshoptSimplifier));
    const buffers = standIns.flatMap(({ positions, normals, levels }) => {
      return [positions.buffer, normals.buffer, ...levels.map(({ index }) => index.buffer)];
    });
    scope.postMessage({ id, standIns }, [...new Set(buffers)]);
  }).catch(() => scope.postMessage({ id, standIns: null }, []));
};
