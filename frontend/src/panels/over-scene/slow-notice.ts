import { coalesce, h } from "../../dom";
import type { Session } from "../../state/session";
import type { ReducedDisplay } from "../../state/slow-connection";
import type { SlowCause } from "../../state/slowness";
import { strings } from "../../strings";

/** ms for which the notice that the page is slow is shown. */
const NOTICE_DURATION_MS = 15_000;

/**
 * The notice over the scene while data is thinned: the data and its rate, the slow part, and the remedy. A notice that
 * the page itself is slow is shown only once, for a while.
 */
export class SlowNotice {
  readonly element = h("div", { class: "line-notice", role: "status" });
  private slowPageNotice: "not yet" | "now" | "done" = "not yet";

  constructor(private readonly session: Session) {
    const update = coalesce(() => this.update());
    session.slowConnection.changed.on(update);
    session.slowness.changed.on(update);
    session.displays.treeChanged.on(update);
    session.drawingPace.changed.on(() => {
      if (session.drawingPace.isSlow) this.showSlowPage(update);
      update();
    });
    this.update();
  }

  private update(): void {
    const { slowConnection, slowness, drawingPace } = this.session;
    const { reducedDisplays } = slowConnection;
    const texts = strings.sharing;
    const cause = chooseCause(slowness.cause, this.slowPageNotice === "now", reducedDisplays.length);
    this.element.hidden = reducedDisplays.length === 0 && this.slowPageNotice !== "now";
    const lines = reducedDisplays.map((display) => h("div", {}, h("b", {}, this.nameOf(display)), ` ${formatReduction(display)}`));
    if (this.slowPageNotice === "now" && drawingPace.softwareRenderer !== null) lines.push(h("div", {}, texts.software(drawingPace.softwareRenderer)));
    if (this.slowPageNotice === "now" && this.isLitAutomatically) lines.push(h("div", {}, texts.plainLight));
    this.element.replaceChildren(h("strong", {}, texts.slow[cause]), h("div", {}, texts.slowHints[cause]), ...lines);
  }

  /** Whether any light is set to Automatic, which means the camera's light where the page is slow. */
  private get isLitAutomatically(): boolean {
    const { globalOptions, displays } = this.session.displays;
    return [globalOptions, ...displays.map(({ rows }) => rows)].some((rows) => rows.text("", "Light") === "Automatic");
  }

  private showSlowPage(update: () => void): void {
    if (this.slowPageNotice !== "not yet") return;
    this.slowPageNotice = "now";
    setTimeout(() => {
      this.slowPageNotice = "done";
      update();
    }, NOTICE_DURATION_MS);
  }

  private nameOf({ display }: ReducedDisplay): string {
    return this.session.displays.find(display)?.name ?? display;
  }
}

/**
 * Returns the cause to show. The notice about a slow page stays for a while after the page has recovered, unless data
 * is reduced.
 */
export function chooseCause(cause: SlowCause, isNoticeShown: boolean, reducedCount: number): SlowCause {
  return isNoticeShown && reducedCount === 0 ? "page" : cause;
}

function formatReduction({ reduction, rate }: ReducedDisplay): string {
  const texts = strings.sharing;
  const amount = reduction.kind === "points" ? texts.points(reduction.step) : texts.image(reduction);
  return rate === null ? amount : `${amount}, ${rate.toFixed(1)} Hz`;
}
