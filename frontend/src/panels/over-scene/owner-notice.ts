import { h } from "../../dom";
import type { DisplayState } from "../../state/displays";
import type { Session } from "../../state/session";
import { strings } from "../../strings";

/** How long the notice is shown, ms. */
const TOLD_MS = 15_000;

/** Over the scene for a while when the description of one node takes the place of another's: what the display's status says. */
export class OwnerNotice {
  readonly element = h("div", { class: "line-notice", role: "status", data: { notice: "owner" } });
  private readonly told = new Map<string, string>();
  private timer: ReturnType<typeof setTimeout> | undefined;

  constructor(private readonly session: Session) {
    this.element.hidden = true;
    session.displays.statusChanged.on((display) => {
      if (display?.cls.endsWith("/RobotModel") === true) this.look(display);
    });
  }

  /** A warning about its topic is what a RobotModel with a robot has while several descriptions come that are not the same. */
  private look({ id, name, status }: DisplayState): void {
    if ((this.session.robots.get(id)?.links.length ?? 0) === 0) return;
    const text = status.find((row) => row.name === "Topic" && row.level === "warn")?.text ?? "";
    if (text === (this.told.get(id) ?? "")) return;
    this.told.set(id, text);
    if (text === "") return;
    this.element.replaceChildren(h("strong", {}, strings.displays.otherDescription), h("div", {}, h("b", {}, name), ` ${text}`));
    this.element.hidden = false;
    clearTimeout(this.timer);
    this.timer = setTimeout(() => (this.element.hidden = true), TOLD_MS);
  }
}
