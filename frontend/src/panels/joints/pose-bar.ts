import { createButton, h } from "../../dom";
import { createIcon } from "../../icons";
import { parseSrdf, formatSrdf, matchesPose, type NamedPose } from "../../state/named-poses";
import type { Session } from "../../state/session";
import { strings } from "../../strings";
import { openMenu } from "../../widgets/menu";
import { saveText } from "../../widgets/save-file";

/** Named poses of the robot, which can be recalled, saved, and exported and imported as SRDF. */
export class PoseBar {
  readonly element: HTMLElement;
  private readonly chipBox = h("div", { class: "pose-chips" });
  private readonly nameField = h("input", { class: "field pose-name" });
  private readonly notice = h("p", { class: "hint pose-notice", role: "status" });
  private readonly fileInput = h("input");

  constructor(private readonly session: Session) {
    const texts = strings.description.poses;
    this.nameField.placeholder = texts.nameShort;
    this.nameField.setAttribute("aria-label", texts.name);
    this.nameField.maxLength = 60;
    this.nameField.addEventListener("keydown", (event) => {
      if (event.key === "Enter") this.save();
      event.stopPropagation();
    });
    this.fileInput.type = "file";
    this.fileInput.accept = ".srdf,.xml,.xacro";
    this.fileInput.hidden = true;
    this.fileInput.addEventListener("change", () => void this.importFile());
    const moreButton = createButton(texts.more, () => this.openMoreMenu(moreButton), "tool bare", createIcon("more"));
    moreButton.setAttribute("aria-haspopup", "menu");
    const nameRow = h(
      "div",
      { class: "bar-row" },
      h("span", { class: "bar-label", title: texts.kept }, texts.label),
      this.nameField,
      createButton(texts.saveHint, () => this.save(), "tool", texts.save),
      moreButton,
    );
    this.notice.hidden = true;
    this.element = h("div", { class: "joint-bar poses", role: "group", aria: { label: texts.label } }, nameRow, this.chipBox, this.notice, this.fileInput);
    const { poses, joints, robotChanged } = session;
    poses.changed.on(() => this.show());
    robotChanged.on(() => this.show());
    joints.positionsChanged.on(() => this.markCurrent());
    this.show();
  }

  private get robotName(): string {
    return this.session.robot?.name ?? "";
  }

  private show(): void {
    this.chipBox.replaceChildren(...this.session.poses.posesOf(this.robotName).map((pose) => this.createChip(pose)));
    this.markCurrent();
  }

  private createChip(pose: NamedPose): HTMLElement {
    const texts = strings.description.poses;
    return h(
      "span",
      { class: "chip", data: { pose: pose.name } },
      createButton(texts.recall(pose.name), () => this.session.joints.move(pose.positions), "chip-name", pose.name),
      createButton(texts.remove(pose.name), () => this.session.poses.remove(this.robotName, pose.name), "chip-remove", createIcon("close")),
    );
  }

  /** Marks the poses that match the robot's current joint positions. */
  private markCurrent(): void {
    const { poses, joints } = this.session;
    const namedPoses = poses.posesOf(this.robotName);
    this.chipBox.querySelectorAll<HTMLElement>(".chip").forEach((chip) => {
      const pose = namedPoses.find((namedPose) => namedPose.name === chip.dataset["pose"]);
      chip.classList.toggle("on", pose !== undefined && matchesPose(pose, joints.positions));
    });
  }

  private save(): void {
    const name = this.nameField.value.trim();
    const { controls, positions } = this.session.joints;
    if (name === "" || !controls) {
      this.nameField.focus();
      return;
    }
    const independentJoints = controls.filter((joint) => joint.mimic === null);
    const jointPositions = independentJoints.map((joint) => [joint.name, positions[joint.name] ?? joint.zero] as const);
    this.session.poses.save(this.robotName, { name, positions: Object.fromEntries(jointPositions) });
    this.nameField.value = "";
    this.notice.hidden = true;
  }

  private openMoreMenu(anchor: HTMLElement): void {
    const texts = strings.description.poses;
    openMenu(anchor, [
      { label: texts.export, run: () => this.export() },
      { label: texts.import, run: () => this.fileInput.click() },
    ]);
  }

  private export(): void {
    saveText(`${this.robotName || "robot"}.srdf`, formatSrdf(this.robotName, this.session.poses.posesOf(this.robotName)), "application/xml");
  }

  private async importFile(): Promise<void> {
    const file = this.fileInput.files?.[0];
    if (!file) return;
    const poses = parseSrdf(await file.text());
    this.fileInput.value = "";
    this.notice.hidden = poses.length > 0;
    this.notice.textContent = strings.description.poses.nothingFound;
    if (poses.length > 0) this.session.poses.save(this.robotName, ...poses);
  }
}
