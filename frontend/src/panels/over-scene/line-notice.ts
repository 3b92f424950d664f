import { coalesced, h } from "../../dom";
import type { Session } from "../../state/session";
import type { Reduced } from "../../state/slow-line";
import { strings } from "../../strings";

/** How long it is told that the page is slow. */
const TOLD_MS = 15_000;

/**
 * Over the scene while not all can be shown: what comes thinned and how often, and whether the line or the page is what
 * is slow. That the page is, is told by itself once.
 */
export class LineNotice {
  readonly element = h("div", { class: "line-notice", role: "status" });
  private told: "not yet" | "now" | "done" = "not yet";

  constructor(private readonly session: Session) {
    const update = coalesced(() => this.update());
    session.slowLine.changed.on(update);
    session.displays.treeChanged.on(update);
    session.pace.changed.on(() => {
      if (session.pace.isSlow) this.tellSlowPage(update);
      update();
    });
    this.update();
  }

  private update(): void {
    const { slowLine, pace } = this.session;
    const { reduced } = slowLine;
    const words = strings.sharing;
    const isPage = isAboutPage(pace.isSlow, this.told === "now", reduced.length);
    this.element.hidden = reduced.length === 0 && this.told !== "now";
    this.element.title = isPage ? words.slowPageHint : words.slowLineHint;
    const lines = reduced.map((each) => h("div", {}, h("b", {}, this.name(each)), ` ${lineText(each)}`));
    if (this.told === "now" && pace.software !== null) lines.push(h("div", {}, words.software(pace.software)));
    if (this.told === "now" && this.isLitAutomatically) lines.push(h("div", {}, words.plainLight));
    this.element.replaceChildren(h("strong", {}, isPage ? words.slowPage : words.slowLine), ...lines);
  }

  /** Whether a light was left to the page, which takes the camera's where it is slow. */
  private get isLitAutomatically(): boolean {
    const { globalOptions, displays } = this.session.displays;
    return [globalOptions, ...displays.map(({ rows }) => rows)].some((rows) => rows.text("", "Light") === "Automatic");
  }

  private tellSlowPage(update: () => void): void {
    if (this.told !== "not yet") return;
    this.told = "now";
    setTimeout(() => {
      this.told = "done";
      update();
    }, TOLD_MS);
  }

  private name({ display }: Reduced): string {
    return this.session.displays.find(display)?.name ?? display;
  }
}

/** Whether the page is what is slow; where it no longer is, the notice tells so for a while, unless the line is. */
export function isAboutPage(isSlow: boolean, isTold: boolean, reduced: number): boolean {
  return isSlow || (isTold && reduced === 0);
}

function lineText({ reduction, rate }: Reduced): string {
  const words = strings.sharing;
  const what = reduction.kind === "points" ? words.points(reduction.step) : words.image(reduction);
  return rate === null ? what : `${what}, ${rate.toFixed(1)} Hz`;
}
