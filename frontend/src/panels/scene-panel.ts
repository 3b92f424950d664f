import { h } from "../dom";
import type { Session } from "../state/session";
import { strings } from "../strings";
import { ConnectionNotice } from "./connection-notice";
import { DiagnosticsBanner } from "./diagnostics-banner";
import { OrientationSign } from "./orientation-sign";
import type { Panel } from "./panel";
import { SelectionCard } from "./selection-card";

/** The 3-D view and what lies over it. */
export class ScenePanel implements Panel {
  readonly id = "scene";
  readonly icon = "cube";
  readonly element: HTMLElement;
  /** Where the canvas goes. */
  readonly container = h("div", { class: "canvas-box", role: "region", aria: { label: strings.scene.label } });
  private readonly waiting = h("div", { class: "waiting" }, h("span", { class: "pulse" }), strings.scene.waiting);

  constructor(session: Session, showDiagnostics: () => void) {
    const banner = new DiagnosticsBanner(session, showDiagnostics);
    const notice = new ConnectionNotice(session.connection);
    const card = new SelectionCard(session);
    const sign = new OrientationSign(session.view);
    this.element = h(
      "div",
      { class: "scene-panel" },
      this.container,
      h("div", { class: "overlay" }, h("div", { class: "notices" }, notice.element, banner.element), this.waiting, card.element, sign.element),
    );
    const update = (): void => {
      this.waiting.hidden = session.robot !== null;
    };
    session.robotChanged.on(update);
    session.displays.treeChanged.on(update);
  }
}
