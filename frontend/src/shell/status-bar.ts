import { h } from "../dom";
import type { Stage } from "../scene/stage";
import type { Session } from "../state/session";
import { strings } from "../strings";

const REFRESH_INTERVAL_MS = 500;

/** The bar in the footer with the connection, the fixed frame, the robot and the frame rate. */
export class StatusBar {
  readonly element: HTMLElement;
  private readonly connectionText = h("span", { class: "connection", role: "status" });
  private readonly fixedFrameText = h("span", { class: "status-value" });
  private readonly robotText = h("span", { class: "status-item" });
  private readonly hintText = h("span", { class: "status-item mouse" });
  private readonly rateText = h("span", { class: "status-item rate" });

  constructor(
    private readonly session: Session,
    private readonly stage: Stage | null,
  ) {
    this.element = h(
      "footer",
      { class: "status-bar" },
      this.connectionText,
      h("span", { class: "status-item" }, h("span", { class: "status-name" }, strings.status.fixedFrame), this.fixedFrameText),
      this.robotText,
      h("span", { class: "spacer" }),
      this.hintText,
      h("span", { class: "spacer" }),
      this.rateText,
    );
    const showHint = (text: string): void => {
      this.hintText.textContent = text;
      this.hintText.title = text;
    };
    session.tools.hintChanged.on(showHint);
    showHint(session.tools.hint);
    session.connection.stateChanged.on(() => this.update());
    session.displays.treeChanged.on(() => this.update());
    session.displays.valueChanged.on(() => this.update());
    session.robotChanged.on(() => this.update());
    session.motionPlanning.robotChanged.on(() => this.update());
    setInterval(() => this.updateRate(), REFRESH_INTERVAL_MS);
    this.update();
    this.updateRate();
  }

  private update(): void {
    const { connection, displays } = this.session;
    this.connectionText.textContent = strings.connection[connection.state];
    this.connectionText.dataset["state"] = connection.state;
    this.fixedFrameText.textContent = displays.fixedFrame;
    this.showRobot();
  }

  /** Shows the robot of a RobotModel display, or else the one whose motions are planned. */
  private showRobot(): void {
    const { robot, motionPlanning } = this.session;
    const shown = robot ? { name: robot.name, linkCount: robot.links.length } : motionPlanning.robot;
    this.robotText.replaceChildren(
      h("span", { class: "status-value" }, shown ? shown.name : strings.status.noRobot),
      shown ? h("span", { class: "status-name" }, strings.status.links(shown.linkCount)) : "",
    );
  }

  private updateRate(): void {
    if (!this.stage) return;
    const rate = this.stage.loop.computeFrameRate(performance.now());
    const { drawingPace } = this.session;
    const fps = rate === null ? strings.status.idle : strings.status.fps(rate);
    const text = rate !== null && drawingPace.isSlow ? strings.status.slow(fps) : fps;
    if (this.rateText.textContent !== text) this.rateText.textContent = text;
    const frameCount = strings.status.frames(this.stage.loop.framesDrawn);
    this.rateText.title = drawingPace.softwareRenderer === null ? frameCount : `${frameCount}. ${strings.sharing.software(drawingPace.softwareRenderer)}`;
  }
}
