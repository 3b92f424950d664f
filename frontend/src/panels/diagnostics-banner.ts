import { button, h } from "../dom";
import { icon } from "../icons";
import type { DiagnosticItem } from "../protocol";
import type { Session } from "../state/session";
import { strings } from "../strings";
import { placeText, shortPath } from "./place";

/** Codes of findings about files of the viewer: the robot is shown in spite of them. */
const NOT_OF_DESCRIPTIONS = /^(RVIZ|VIEW)/;

/** Over the scene while the description has an error: its cause, its hint, and whether the robot seen is the last good one. */
export class DiagnosticsBanner {
  readonly element = h("div", { class: "banner", role: "alert" });

  constructor(
    private readonly session: Session,
    private readonly showAll: () => void,
  ) {
    session.diagnosticsChanged.on(() => this.update());
    this.update();
  }

  private update(): void {
    const errors = this.session.diagnostics.filter((item) => item.severity === "error");
    const [first] = errors;
    this.element.hidden = !first;
    if (!first) return;
    const words = strings.diagnostics;
    const place = first.file === null ? "" : placeText(shortPath(first.file, 2), first.line, first.column);
    const more = errors.length > 1 ? ` ${words.more(errors.length - 1)}` : "";
    this.element.replaceChildren(
      icon("error", "level-error"),
      h(
        "div",
        { class: "banner-text" },
        h("strong", {}, first.message + more),
        h("span", {}, place ? h("span", { class: "place" }, place) : null, first.hints[0] ?? ""),
        this.keepsRobot(first) ? h("span", {}, words.lastGood) : null,
      ),
      button(words.show, this.showAll, "tool", words.show),
    );
  }

  /** A description with an error changes nothing: what is there when the error comes was there before. */
  private keepsRobot(error: DiagnosticItem): boolean {
    return this.session.robot !== null && !NOT_OF_DESCRIPTIONS.test(error.code);
  }
}
