import { h } from "../../dom";
import type { CatchUpFiles } from "../../protocol";
import type { CourseState } from "../../state/course";
import { strings } from "../../strings";
import { Dialog } from "../../widgets/dialog";

/** Asks whether to take the earlier steps over from the course, and lists the files that this writes. */
export function askToCatchUp(state: CourseState, { new: newFiles, replaced: replacedFiles }: CatchUpFiles): void {
  const texts = strings.learning;
  const folder = state.course?.folder ?? "";
  const createList = (paths: readonly string[]): HTMLElement => h("ul", { class: "catch-up-files", tabIndex: 0 }, ...paths.map((path) => h("li", {}, path.slice(folder.length + 1))));
  const createSection = (text: string, paths: readonly string[]): HTMLElement[] => (paths.length > 0 ? [h("p", {}, text), createList(paths)] : []);
  new Dialog(
    texts.catchUpTitle,
    [h("p", {}, texts.catchUpText), ...createSection(texts.catchUpReplaced(replacedFiles.length), replacedFiles), ...createSection(texts.catchUpNew(newFiles.length), newFiles)],
    [{ label: strings.shell.cancel }, { label: texts.catchUpTake, run: () => (state.catchUp(), undefined), isPrimary: true }],
  ).open();
}
