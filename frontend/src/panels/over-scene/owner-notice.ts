import { h } from "../../dom";
import type { DisplayState } from "../../state/displays";
import type { Session } from "../../state/session";
import { strings } from "../../strings";

/** How long the notice is shown, ms. */
const NOTICE_DURATION_MS = 15_000;

/**
 * The notice over the scene for a while after one node's description replaced another's, with the text of the display's
 * status.
 */
export class OwnerNotice {
  readonly element = h("div", { class: "line-notice", role: "status", data: { notice: "owner" } });
  private readonly lastTexts = new Map<string, string>();
  private timer: ReturnType<typeof setTimeout> | undefined;

  constructor(private readonly session: Session) {
    this.element.hidden = true;
    session.displays.statusChanged.on((display) => {
      if (display?.cls.endsWith("/RobotModel") === true) this.showWarning(display);
    });
  }

  /**
   * Shows a warning about a RobotModel's topic. With a robot, such a warning means that several different descriptions
   * are published.
   */
  private showWarning({ id, name, status }: DisplayState): void {
    if ((this.session.robots.get(id)?.links.length ?? 0) === 0) return;
    const text = status.find((row) => row.name === "Topic" && row.level === "warn")?.text ?? "";
    if (text === (this.lastTexts.get(id) ?? "")) return;
    this.lastTexts.set(id, text);
    if (text === "") return;
    this.element.replaceChildren(h("strong", {}, strings.displays.otherDescription), h("div", {}, h("b", {}, name), ` ${text}`));
    this.element.hidden = false;
    clearTimeout(this.timer);
    this.timer = setTimeout(() => (this.element.hidden = true), NOTICE_DURATION_MS);
  }
}
