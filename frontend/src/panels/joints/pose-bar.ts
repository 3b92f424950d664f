import { button, h } from "../../dom";
import { icon } from "../../icons";
import { readSrdf, toSrdf, matchesPose, type NamedPose } from "../../state/named-poses";
import type { Session } from "../../state/session";
import { strings } from "../../strings";
import { openMenu } from "../../widgets/menu";
import { saveText } from "../../widgets/save-file";

/** Named poses of the robot, which can be recalled, saved, and exported and imported as SRDF. */
export class PoseBar {
  readonly element: HTMLElement;
  private readonly chips = h("div", { class: "pose-chips" });
  private readonly name = h("input", { class: "field pose-name" });
  private readonly notice = h("p", { class: "hint pose-notice", role: "status" });
  private readonly picker = h("input");

  constructor(private readonly session: Session) {
    const texts = strings.description.poses;
    this.name.placeholder = texts.nameShort;
    this.name.setAttribute("aria-label", texts.name);
    this.name.maxLength = 60;
    this.name.addEventListener("keydown", (event) => {
      if (event.key === "Enter") this.save();
      event.stopPropagation();
    });
    this.picker.type = "file";
    this.picker.accept = ".srdf,.xml,.xacro";
    this.picker.hidden = true;
    this.picker.addEventListener("change", () => void this.importFile());
    const more = button(texts.more, () => this.openMore(more), "tool bare", icon("more"));
    more.setAttribute("aria-haspopup", "menu");
    const entry = h(
      "div",
      { class: "bar-row" },
      h("span", { class: "bar-label", title: texts.kept }, texts.label),
      this.name,
      button(texts.saveHint, () => this.save(), "tool", texts.save),
      more,
    );
    this.notice.hidden = true;
    this.element = h("div", { class: "joint-bar poses", role: "group", aria: { label: texts.label } }, entry, this.chips, this.notice, this.picker);
    const { poses, joints, robotChanged } = session;
    poses.changed.on(() => this.show());
    robotChanged.on(() => this.show());
    joints.positionsChanged.on(() => this.mark());
    this.show();
  }

  private get robot(): string {
    return this.session.robot?.name ?? "";
  }

  private show(): void {
    this.chips.replaceChildren(...this.session.poses.posesOf(this.robot).map((pose) => this.chip(pose)));
    this.mark();
  }

  private chip(pose: NamedPose): HTMLElement {
    const texts = strings.description.poses;
    return h(
      "span",
      { class: "chip", data: { pose: pose.name } },
      button(texts.recall(pose.name), () => this.session.joints.move(pose.positions), "chip-name", pose.name),
      button(texts.remove(pose.name), () => this.session.poses.remove(this.robot, pose.name), "chip-remove", icon("close")),
    );
  }

  /** Marks the poses that the robot is in. */
  private mark(): void {
    const { poses, joints } = this.session;
    const known = poses.posesOf(this.robot);
    this.chips.querySelectorAll<HTMLElement>(".chip").forEach((chip) => {
      const pose = known.find((each) => each.name === chip.dataset["pose"]);
      chip.classList.toggle("on", pose !== undefined && matchesPose(pose, joints.positions));
    });
  }

  private save(): void {
    const name = this.name.value.trim();
    const { controls, positions } = this.session.joints;
    if (name === "" || !controls) {
      this.name.focus();
      return;
    }
    const free = controls.filter((joint) => joint.mimic === null);
    const saved = free.map((joint) => [joint.name, positions[joint.name] ?? joint.zero] as const);
    this.session.poses.save(this.robot, { name, positions: Object.fromEntries(saved) });
    this.name.value = "";
    this.notice.hidden = true;
  }

  private openMore(anchor: HTMLElement): void {
    const texts = strings.description.poses;
    openMenu(anchor, [
      { label: texts.export, run: () => this.export() },
      { label: texts.import, run: () => this.picker.click() },
    ]);
  }

  private export(): void {
    saveText(`${this.robot || "robot"}.srdf`, toSrdf(this.robot, this.session.poses.posesOf(this.robot)), "application/xml");
  }

  private async importFile(): Promise<void> {
    const file = this.picker.files?.[0];
    if (!file) return;
    const poses = readSrdf(await file.text());
    this.picker.value = "";
    this.notice.hidden = poses.length > 0;
    this.notice.textContent = strings.description.poses.nothingFound;
    if (poses.length > 0) this.session.poses.save(this.robot, ...poses);
  }
}
