import { button, h } from "../dom";
import { icon } from "../icons";
import type { Session } from "../state/session";
import { strings } from "../strings";
import { placeText, shortPath } from "./place";

/** Over the scene while the description has an error: the robot seen is the last good one. */
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
        h("span", {}, place ? h("span", { class: "place" }, place) : null, this.session.robot ? words.lastGood : ""),
      ),
      button(words.show, this.showAll, "tool", words.show),
    );
  }
}
