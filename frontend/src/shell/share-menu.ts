import type { Tokens } from "../connection/tokens";
import { createButton, h } from "../dom";
import type { Stage } from "../scene/stage";
import { formatDuration, VideoRecorder } from "../scene/video";
import type { Session } from "../state/session";
import { strings } from "../strings";
import { copyText } from "../widgets/copy-text";
import { showNotice } from "../widgets/dialog";
import type { MenuEntry } from "../widgets/menu";
import { saveBlob, saveFromUrl } from "../widgets/save-file";

const SCREENSHOT_SCALES = [1, 2, 4] as const;

/** The menu of exports: images and videos of the scene, and the robot as a file. */
export class ShareMenu {
  /** The button shown while a video is recorded: it shows the duration, and a click stops the recording. */
  readonly element: HTMLElement;
  private readonly recorder: VideoRecorder | null;
  private readonly stopButton: HTMLButtonElement;

  constructor(
    private readonly session: Session,
    private readonly stage: Stage | null,
    private readonly tokens: Tokens,
  ) {
    this.recorder = stage && VideoRecorder.isPossible ? createRecorder(stage, (recorder) => this.saveVideo(recorder)) : null;
    this.stopButton = createButton(strings.sharing.recording, () => this.recorder?.stop(), "tool recording", "");
    this.element = h("span", { class: "recorder", role: "status" }, this.stopButton);
    this.recorder?.changed.on(() => this.showDuration());
    this.showDuration();
    session.connection.on("export_ready", ({ url, name, outside_files: outsideFiles }) => {
      saveFromUrl(name, new URL(url, document.baseURI).href);
      if (outsideFiles.length > 0) showNotice(strings.sharing.exportOutside, strings.sharing.exportOutsideHint, outsideFiles);
    });
    session.connection.on("export_failed", ({ message }) => showNotice(strings.sharing.exportFailed, message));
  }

  createEntries(): MenuEntry[] {
    const texts = strings.sharing;
    const { stage, recorder } = this;
    const isRecording = recorder?.isRecording ?? false;
    return [
      ...SCREENSHOT_SCALES.map((scale): MenuEntry => ({
        label: scale === 1 ? texts.screenshot : texts.screenshotScaled(scale),
        icon: "camera",
        isDisabled: stage === null,
        run: () => void this.saveImage(scale),
      })),
      {
        label: isRecording ? texts.stopVideo(formatDuration(recorder?.seconds ?? 0)) : texts.startVideo,
        icon: "record",
        isDisabled: recorder === null,
        hasLineAbove: true,
        run: () => (isRecording ? recorder?.stop() : recorder?.start()),
      },
      { label: texts.exportHtml, icon: "download", hasLineAbove: true, isDisabled: this.hasNoRobot, run: () => this.requestExport("html") },
      { label: texts.exportGlb, icon: "download", isDisabled: this.hasNoRobot, run: () => this.requestExport("glb") },
      { label: texts.copyLink, hint: texts.copyLinkHint, icon: "link", hasLineAbove: true, run: () => void this.copyLink() },
    ];
  }

  private get hasNoRobot(): boolean {
    return this.session.robot === null;
  }

  private async saveImage(scale: number): Promise<void> {
    const image = await this.stage?.takeScreenshot(scale);
    if (image) saveBlob(this.createFileName("png"), image);
  }

  private saveVideo(recorder: Blob): void {
    saveBlob(this.createFileName(recorder.type.startsWith("video/mp4") ? "mp4" : "webm"), recorder);
  }

  private requestExport(format: "html" | "glb"): void {
    const { cls, name, values } = this.session.view.current;
    this.session.connection.send({ type: "request_export", format, view: { cls, name, values: { ...values } } });
  }

  private async copyLink(): Promise<void> {
    const texts = strings.sharing;
    const { link } = this.tokens;
    if (await copyText(link)) showNotice(texts.linkCopied, texts.copyLinkHint);
    else showNotice(texts.linkHere, link);
  }

  private showDuration(): void {
    const isRecording = this.recorder?.isRecording ?? false;
    this.element.hidden = !isRecording;
    const label = strings.sharing.stopVideo(formatDuration(this.recorder?.seconds ?? 0));
    this.stopButton.textContent = `● ${formatDuration(this.recorder?.seconds ?? 0)}`;
    this.stopButton.title = label;
    this.stopButton.setAttribute("aria-label", label);
  }

  /** Returns a file name that contains the robot's name and the current time. */
  private createFileName(extension: string): string {
    const name = (this.session.robot?.name ?? "scene").replace(/[^\p{L}\p{N}._-]+/gu, "_");
    const time = new Date().toISOString().slice(0, 19).replace(/[T:]/g, "-");
    return `${name}-${time}.${extension}`;
  }
}

function createRecorder({ viewport, loop }: Stage, onFinished: (recorder: Blob) => void): VideoRecorder {
  return new VideoRecorder(viewport.canvas, () => loop.invalidate(), onFinished);
}
