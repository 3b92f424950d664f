import { createButton, coalesce, h } from "../../dom";
import { createIcon } from "../../icons";
import type { TopicChoice } from "../../protocol";
import { findLargestRoot } from "../../state/frame-tree";
import { findObviousDisplay } from "../../state/obvious-display";
import type { Session } from "../../state/session";
import { strings } from "../../strings";

const ROBOT_MODEL = "rviz_default_plugins/RobotModel";
/** How long (ms) the notice waits for the frame: localization publishes it only after its start. */
const NOTICE_DELAY_MS = 3000;

/**
 * The notice over the scene while the Fixed Frame does not exist: its name, and a button that uses an existing frame
 * and adds the robot.
 */
export class FrameNotice {
  readonly element = h("div", { class: "line-notice failed", role: "alert", data: { notice: "frame" } });
  private timer: ReturnType<typeof setTimeout> | undefined;
  /** The missing frame for which the notice was last shown or scheduled. */
  private reportedFrame: string | null = null;
  private robotTopic: TopicChoice | null = null;

  constructor(private readonly session: Session) {
    const { displays, frames, configuration } = session;
    this.element.hidden = true;
    const updateFrame = coalesce(() => this.updateFrame());
    for (const signal of [displays.treeChanged, frames.tableChanged]) signal.on(updateFrame);
    displays.statusChanged.on(updateFrame);
    displays.valueChanged.on(updateFrame);
    configuration.choicesArrived.on(({ topics }) => {
      this.robotTopic = topics.find((topic) => topic.classes.length > 0 && findObviousDisplay(topic) === ROBOT_MODEL) ?? null;
      if (!this.element.hidden) this.show();
    });
  }

  private get currentMissingFrame(): string | null {
    const { globalStatus, fixedFrame } = this.session.displays;
    return globalStatus.some(({ name, level }) => name === "Fixed Frame" && level === "error") ? fixedFrame : null;
  }

  private updateFrame(): void {
    const { currentMissingFrame } = this;
    if (currentMissingFrame === this.reportedFrame) {
      if (!this.element.hidden) this.show();
      return;
    }
    clearTimeout(this.timer);
    this.reportedFrame = currentMissingFrame;
    this.element.hidden = true;
    if (currentMissingFrame === null) return;
    this.session.configuration.requestChoices();
    this.timer = setTimeout(() => this.show(), NOTICE_DELAY_MS);
  }

  private show(): void {
    const texts = strings.scene.frame;
    const root = findLargestRoot(this.session.frames);
    if (this.reportedFrame === null || root === null) return;
    const closeButton = createButton(strings.diagnostics.close, () => (this.element.hidden = true), "tool bare", createIcon("close"));
    const { robotTopic } = this;
    const addsRobot = robotTopic !== null && !this.session.displays.displays.some(({ cls }) => cls === ROBOT_MODEL);
    const label = addsRobot ? texts.useWithRobot(root) : texts.use(root);
    const useButton = createButton(label, () => this.useFrame(root, addsRobot ? robotTopic.topic : null), "tool framed primary", label);
    this.element.replaceChildren(
      h("header", {}, h("strong", {}, texts.missing(this.reportedFrame)), closeButton),
      h("div", {}, texts.hint),
      h("div", { class: "notice-choices" }, useButton),
    );
    this.element.hidden = false;
  }

  private useFrame(frame: string, description: string | null): void {
    const { session } = this;
    const row = session.displays.globalOptions.find("Fixed Frame");
    if (row) session.setProperty(row.id, frame);
    if (description === null) return;
    session.view.lookAtRobots();
    session.configuration.add(ROBOT_MODEL, "RobotModel", null, description);
  }
}
