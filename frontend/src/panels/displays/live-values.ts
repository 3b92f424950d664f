import type { Session } from "../../state/session";
import type { TreeView } from "../../tree/tree-view";

const UPDATE_INTERVAL_MS = 100;

/** Updates the rows whose values follow the scene, a few times a second while any of them is visible. */
export function followLiveValues(tree: TreeView, session: Session): void {
  let timer = 0;
  const schedule = (): void => {
    if (timer !== 0 || !tree.hasLiveRows) return;
    timer = window.setTimeout(() => {
      timer = 0;
      tree.updateLiveRows();
    }, UPDATE_INTERVAL_MS);
  };
  session.frames.posesChanged.on(schedule);
  session.data.received.on(schedule);
}
