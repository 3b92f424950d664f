import { h } from "../../dom";
import type { Session } from "../../state/session";
import { strings } from "../../strings";
import type { WorldCommands } from "../modeling/world-commands";
import type { Panel } from "../panel";
import { createTalkButton } from "../voice/talk-button";
import { VoiceNotice } from "../voice/voice-notice";
import { ArgumentFormCard } from "./argument-form";
import { CardColumn, type CoveredScene } from "./card-column";
import { ConnectionNotice } from "./connection-notice";
import { DiagnosticsBanner } from "./diagnostics-banner";
import { FrameNotice } from "./frame-notice";
import { GoalNotice } from "./goal-notice";
import { InspectMenu } from "./inspect-menu";
import { SlowNotice } from "./slow-notice";
import { MeshNotice } from "./mesh-notice";
import { OrientationSign } from "./orientation-sign";
import { OwnerNotice } from "./owner-notice";
import { bindSceneMenus } from "./scene-menu";
import { SelectionCard } from "./selection-card";
import { SimulationBar } from "./simulation-bar";
import { ToolNotice } from "./tool-notice";
import { Toolbar } from "./toolbar";

/** The 3-D view and its overlays. */
export class ScenePanel implements Panel {
  readonly id = "scene";
  readonly icon = "cube";
  readonly element: HTMLElement;
  /** The element that holds the canvas. */
  readonly container = h("div", { class: "canvas-box", role: "region", aria: { label: strings.scene.label } });
  /** The scene and its overlays, which full screen shows. */
  readonly box: HTMLElement;
  private readonly cardColumn = new CardColumn();
  private readonly notices = h("div", { class: "notices" });
  private readonly waitingNote = h("div", { class: "waiting" }, h("span", { class: "pulse" }), strings.scene.waiting);

  constructor(session: Session, commands: WorldCommands, fit: () => void, showDiagnostics: () => void, showKeys: () => void) {
    const toolbar = new Toolbar(session.tools, fit, showKeys, createTalkButton(session.voice, "scene-tool small talk"));
    const banner = new DiagnosticsBanner(session, showDiagnostics);
    const connectionNotice = new ConnectionNotice(session.connection);
    const selectionCard = new SelectionCard(session, this.cardColumn, () => session.editing.editRequested.emit());
    const inspect = new InspectMenu(session, this.cardColumn.onCardToggled);
    const orientationSign = new OrientationSign(session);
    const simulationBar = new SimulationBar(session.simulation, session.modeling, commands);
    const form = new ArgumentFormCard(session.connection);
    this.notices.append(simulationBar.element, connectionNotice.element, banner.element, form.element);
    const notices = [
      new ToolNotice(session.tools),
      new GoalNotice(session.monitor.navigation),
      new FrameNotice(session),
      new SlowNotice(session),
      new OwnerNotice(session),
      new MeshNotice(session.meshProgress),
      new VoiceNotice(session.voice, session.enrolledWords),
    ];
    this.cardColumn.element.append(inspect.element, selectionCard.element, ...notices.map((notice) => notice.element));
    this.box = h(
      "div",
      { class: "scene-box" },
      this.container,
      h("div", { class: "overlay" }, this.notices, this.cardColumn.element, this.waitingNote, orientationSign.element),
    );
    bindSceneMenus(this.box, session.sceneMenu);
    this.element = h("div", { class: "scene-panel" }, toolbar.element, this.box);
    const update = (): void => {
      const isRobotExpected = session.displays.displays.some(({ cls, isEnabled }) => isEnabled && cls.endsWith("/RobotModel"));
      // If a description has an error, the banner explains why no robot appears.
      this.waitingNote.hidden = session.robot !== null || !isRobotExpected || banner.hasError;
    };
    session.diagnosticsChanged.on(update);
    session.robotChanged.on(update);
    session.displays.treeChanged.on(update);
    session.displays.enabledChanged.on(update);
  }

  /** Connects the cards with the scene below them. */
  connectScene(scene: CoveredScene): void {
    this.cardColumn.connectScene(scene);
    new ResizeObserver(() => scene.avoidNotices(this.notices.offsetHeight > 0 ? this.notices.offsetTop + this.notices.offsetHeight : 0)).observe(this.notices);
  }
}
