import type { Tokens } from "../connection/tokens";
import { button, h } from "../dom";
import type { Stage } from "../scene/stage";
import { formatTime, VideoRecorder } from "../scene/video";
import type { Session } from "../state/session";
import { strings } from "../strings";
import { copyText } from "../widgets/copy-text";
import { showNotice } from "../widgets/dialog";
import type { MenuEntry } from "../widgets/menu";
import { saveBlob, saveFrom } from "../widgets/save-file";

const SCALES = [1, 2, 4] as const;

/** The menu of exports: images and videos of the scene, and the robot as a file. */
export class ShareMenu {
  /** The button shown while a video is recorded: its duration, and a click to stop. */
  readonly element: HTMLElement;
  private readonly video: VideoRecorder | null;
  private readonly stop: HTMLButtonElement;

  constructor(
    private readonly session: Session,
    private readonly stage: Stage | null,
    private readonly tokens: Tokens,
  ) {
    this.video = stage && VideoRecorder.isPossible ? recorderOf(stage, (video) => this.saveVideo(video)) : null;
    this.stop = button(strings.sharing.recording, () => this.video?.stop(), "tool recording", "");
    this.element = h("span", { class: "recorder", role: "status" }, this.stop);
    this.video?.changed.on(() => this.showTime());
    this.showTime();
    session.connection.on("export_ready", ({ url, name, outside }) => {
      saveFrom(name, new URL(url, document.baseURI).href);
      if (outside.length > 0) showNotice(strings.sharing.exportOutside, strings.sharing.exportOutsideHint, outside);
    });
    session.connection.on("export_failed", ({ message }) => showNotice(strings.sharing.exportFailed, message));
  }

  entries(): MenuEntry[] {
    const texts = strings.sharing;
    const { stage, video } = this;
    const recording = video?.isRecording ?? false;
    return [
      ...SCALES.map((scale): MenuEntry => ({
        label: scale === 1 ? texts.screenshot : texts.screenshotScaled(scale),
        icon: "camera",
        disabled: stage === null,
        run: () => void this.saveImage(scale),
      })),
      {
        label: recording ? texts.stopVideo(formatTime(video?.seconds ?? 0)) : texts.startVideo,
        icon: "record",
        disabled: video === null,
        separate: true,
        run: () => (recording ? video?.stop() : video?.start()),
      },
      { label: texts.exportHtml, icon: "download", separate: true, disabled: this.hasNoRobot, run: () => this.ask("html") },
      { label: texts.exportGlb, icon: "download", disabled: this.hasNoRobot, run: () => this.ask("glb") },
      { label: texts.copyLink, hint: texts.copyLinkHint, icon: "link", separate: true, run: () => void this.copyLink() },
    ];
  }

  private get hasNoRobot(): boolean {
    return this.session.robot === null;
  }

  private async saveImage(scale: number): Promise<void> {
    const image = await this.stage?.takeScreenshot(scale);
    if (image) saveBlob(this.fileName("png"), image);
  }

  private saveVideo(video: Blob): void {
    saveBlob(this.fileName(video.type.startsWith("video/mp4") ? "mp4" : "webm"), video);
  }

  private ask(format: "html" | "glb"): void {
    const { cls, name, values } = this.session.view.current;
    this.session.connection.send({ type: "ask_export", format, view: { cls, name, values: { ...values } } });
  }

  private async copyLink(): Promise<void> {
    const texts = strings.sharing;
    const { link } = this.tokens;
    if (await copyText(link)) showNotice(texts.linkCopied, texts.copyLinkHint);
    else showNotice(texts.linkHere, link);
  }

  private showTime(): void {
    const recording = this.video?.isRecording ?? false;
    this.element.hidden = !recording;
    const label = strings.sharing.stopVideo(formatTime(this.video?.seconds ?? 0));
    this.stop.textContent = `● ${formatTime(this.video?.seconds ?? 0)}`;
    this.stop.title = label;
    this.stop.setAttribute("aria-label", label);
  }

  /** Returns a name from the robot and the current time. */
  private fileName(extension: string): string {
    const name = (this.session.robot?.name ?? "scene").replace(/[^\p{L}\p{N}._-]+/gu, "_");
    const time = new Date().toISOString().slice(0, 19).replace(/[T:]/g, "-");
    return `${name}-${time}.${extension}`;
  }
}

function recorderOf({ viewport, loop }: Stage, finished: (video: Blob) => void): VideoRecorder {
  return new VideoRecorder(viewport.canvas, () => loop.invalidate(), finished);
}
