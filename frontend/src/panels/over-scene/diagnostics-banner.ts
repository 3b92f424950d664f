import { createButton, h } from "../../dom";
import { createIcon, LEVEL_ICONS } from "../../icons";
import type { DiagnosticItem } from "../../protocol";
import type { DisplayState } from "../../state/displays";
import type { Session } from "../../state/session";
import { strings } from "../../strings";
import { formatPlace, shortenPath } from "../place";

/** Codes of findings on files of the viewer, which do not prevent the robot from being shown. */
const VIEWER_CODES = /^(RVIZ|VIEW)/;
/**
 * Codes of warnings that the user needs to understand the scene: the robot has fallen out of the world, the world is
 * slow, or all meshes of the robot are missing.
 */
const SLOW_CODE = "SIM146";
const EXPLAINING_CODES = new Set(["SIM143", SLOW_CODE, "VIEW207"]);
/** Displays for which the simulation renders images. */
const IMAGE_DISPLAYS = /\/(Camera|DepthCloud|Image)$/;

/**
 * The banner over the scene while the description has an error: its cause, its hint, and whether the robot shown is the
 * last valid one. Without an error it shows a warning that explains the scene, until the user closes it.
 */
export class DiagnosticsBanner {
  readonly element = h("div", { class: "banner", role: "alert" });

  private readonly closedMessages = new Set<string>();

  constructor(
    private readonly session: Session,
    private readonly showDiagnostics: () => void,
  ) {
    session.diagnosticsChanged.on(() => this.update());
    this.update();
  }

  /** Whether a description has an error. */
  get hasError(): boolean {
    return this.session.diagnostics.some(({ severity, code }) => severity === "error" && !VIEWER_CODES.test(code));
  }

  private update(): void {
    const diagnostics = this.session.diagnostics;
    const errors = diagnostics.filter((item) => item.severity === "error");
    const item = errors[0] ?? diagnostics.find(({ code, message }) => EXPLAINING_CODES.has(code) && !this.closedMessages.has(message));
    this.element.hidden = !item;
    if (!item) return;
    const texts = strings.diagnostics;
    const isError = item.severity === "error";
    this.element.classList.toggle("warning", !isError);
    const place = item.file === null ? "" : formatPlace(shortenPath(item.file, 2), item.line, item.column);
    const furtherErrors = errors.length > 1 ? ` ${texts.more(errors.length - 1)}` : "";
    this.element.replaceChildren(
      createIcon(LEVEL_ICONS[item.severity], `level-${item.severity}`),
      h(
        "div",
        { class: "banner-text" },
        h("strong", {}, item.message + furtherErrors),
        h("span", {}, place ? h("span", { class: "place" }, place) : null, item.hints[0] ?? ""),
        isError && this.isRobotKept(item) ? h("span", {}, texts.lastGood) : null,
      ),
      ...(item.code === SLOW_CODE && this.imageDisplays.length > 0
        ? [createButton(texts.withoutImages, () => this.switchOffImages(), "tool", texts.withoutImages)]
        : []),
      createButton(texts.show, this.showDiagnostics, "tool", texts.show),
      ...(isError ? [] : [createButton(texts.close, () => this.close(item), "tool", createIcon("close"))]),
    );
  }

  private get imageDisplays(): readonly DisplayState[] {
    return this.session.displays.displays.filter(({ cls, isEnabled }) => isEnabled && IMAGE_DISPLAYS.test(cls));
  }

  private switchOffImages(): void {
    for (const { enabledId } of this.imageDisplays) this.session.setProperty(enabledId, false);
    this.update();
  }

  private close({ message }: DiagnosticItem): void {
    this.closedMessages.add(message);
    this.update();
  }

  /** Whether the robot shown is an earlier one: a description with an error does not replace it. */
  private isRobotKept(error: DiagnosticItem): boolean {
    return this.session.robot !== null && !VIEWER_CODES.test(error.code);
  }
}
