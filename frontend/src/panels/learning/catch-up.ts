import { h } from "../../dom";
import type { CatchUpFiles } from "../../protocol";
import type { CourseState } from "../../state/course";
import { strings } from "../../strings";
import { Dialog } from "../../widgets/dialog";

/** Asks whether the steps before the shown one are to be taken over from the course, and lists the files to write. */
export function askToCatchUp(state: CourseState, { new: created, replaced }: CatchUpFiles): void {
  const texts = strings.learning;
  const folder = state.course?.folder ?? "";
  const list = (paths: readonly string[]): HTMLElement => h("ul", { class: "catch-up-files", tabIndex: 0 }, ...paths.map((path) => h("li", {}, path.slice(folder.length + 1))));
  const part = (text: string, paths: readonly string[]): HTMLElement[] => (paths.length > 0 ? [h("p", {}, text), list(paths)] : []);
  new Dialog(
    texts.catchUpTitle,
    [h("p", {}, texts.catchUpText), ...part(texts.catchUpReplaced(replaced.length), replaced), ...part(texts.catchUpNew(created.length), created)],
    [{ label: strings.shell.cancel }, { label: texts.catchUpTake, run: () => (state.catchUp(), undefined), main: true }],
  ).open();
}
