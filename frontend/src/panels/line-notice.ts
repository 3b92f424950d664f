import { coalesced, h } from "../dom";
import type { Reduced } from "../state/slow-line";
import type { Session } from "../state/session";
import { strings } from "../strings";

/** Over the scene while the line is too slow for all that is shown: what comes thinned, and how often. */
export class LineNotice {
  readonly element = h("div", { class: "line-notice", role: "status", title: strings.sharing.slowLineHint });

  constructor(private readonly session: Session) {
    const update = coalesced(() => this.update());
    session.slowLine.changed.on(update);
    session.displays.treeChanged.on(update);
    this.update();
  }

  private update(): void {
    const { reduced } = this.session.slowLine;
    this.element.hidden = reduced.length === 0;
    const lines = reduced.map((each) => h("div", {}, h("b", {}, this.name(each)), ` ${lineText(each)}`));
    this.element.replaceChildren(h("strong", {}, strings.sharing.slowLine), ...lines);
  }

  private name({ display }: Reduced): string {
    return this.session.displays.find(display)?.name ?? display;
  }
}

function lineText({ reduction, rate }: Reduced): string {
  const words = strings.sharing;
  const what = reduction.kind === "points" ? words.points(reduction.step) : words.image(reduction);
  return rate === null ? what : `${what}, ${rate.toFixed(1)} Hz`;
}
