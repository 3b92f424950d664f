import { setRecordingName, readRecordingName } from "../connection/recording-address";
import type { Tokens } from "../connection/tokens";
import { RefusedError, Upload } from "../connection/upload";
import { h } from "../dom";
import { formatBytesOfTotal } from "../panels/timeline/timeline-text";
import type { Session } from "../state/session";
import { language, strings } from "../strings";
import { Dialog, showNotice } from "../widgets/dialog";
import { readDroppedFiles, findRecording, type DroppedRecording } from "./recording-files";

/**
 * Opens recordings that the user drops on the page, chooses or has recorded: uploads them, and opens the page of the
 * recording.
 */
export class RecordingDrop {
  private readonly dropOverlay = h("div", { class: "drop-veil" }, h("p", {}, strings.recording.dropHere));
  private isBusy = false;

  constructor(
    session: Session,
    private readonly tokens: Tokens,
  ) {
    this.dropOverlay.hidden = true;
    document.body.append(this.dropOverlay);
    document.addEventListener("dragover", (event) => {
      if (!hasFiles(event)) return;
      event.preventDefault();
      this.dropOverlay.hidden = false;
    });
    document.addEventListener("dragleave", (event) => {
      if (event.relatedTarget === null) this.dropOverlay.hidden = true;
    });
    document.addEventListener("drop", (event) => {
      this.dropOverlay.hidden = true;
      if (!hasFiles(event) || !event.dataTransfer) return;
      event.preventDefault();
      void readDroppedFiles(event.dataTransfer).then((recording) => this.openDropped(recording));
    });
    session.recording.viewRequested.on(({ name, url }) => void this.openPage(name, 0, (upload) => upload.openRecording(url)));
    session.connection.on("timeline", ({ live: isLive }) => this.returnToLive(isLive));
  }

  /** Lets the user choose a recording on the browser's machine: its file, or all files of its folder. */
  choose(): void {
    const input = document.createElement("input");
    input.type = "file";
    input.multiple = true;
    input.accept = ".mcap,.db3,.yaml,.zstd";
    input.addEventListener("change", () => {
      const files = [...(input.files ?? [])].map((file) => ({ name: file.name, file }));
      this.openDropped(findRecording(strings.recording.folder, files));
    });
    input.click();
  }

  private openDropped(recording: DroppedRecording): void {
    const texts = strings.recording;
    if (this.isBusy) return;
    if (recording.files.length === 0) showNotice(texts.noRecording, texts.noRecordingHint(recording.name));
    else void this.send(recording);
  }

  private send({ name, files }: DroppedRecording): Promise<void> {
    const totalBytes = files.reduce((sum, { file }) => sum + file.size, 0);
    return this.openPage(name, totalBytes, (upload) => upload.send(name, files));
  }

  /**
   * Opens the page of a recording as soon as the server shows it. Until then, a dialog shows the progress.
   */
  private async openPage(name: string, totalBytes: number, requestRecording: (upload: Upload) => Promise<string | null>): Promise<void> {
    const texts = strings.recording;
    if (this.isBusy) return;
    const progressBar = h("progress", { class: "wide", aria: { label: texts.sending(name) } });
    const progressText = h("p", { role: "status" });
    const showProgress = (sentBytes: number): void => {
      progressBar.max = Math.max(1, totalBytes);
      if (sentBytes < totalBytes) progressBar.value = sentBytes;
      else progressBar.removeAttribute("value");
      progressText.textContent = sentBytes < totalBytes ? formatBytesOfTotal(sentBytes, totalBytes) : texts.opening;
    };
    const upload = new Upload(document.baseURI, this.tokens, language, showProgress);
    let isFinished = false;
    const dialog = new Dialog(texts.sending(name), [progressBar, progressText], [{ label: strings.shell.cancel, isPrimary: true }]);
    dialog.element.addEventListener("close", () => {
      if (!isFinished) upload.cancel();
    });
    this.isBusy = true;
    showProgress(0);
    dialog.open();
    try {
      const recording = await requestRecording(upload);
      if (recording !== null) location.assign(setRecordingName(location.href, recording));
    } catch (error) {
      isFinished = true;
      dialog.close();
      showNotice(texts.notOpened(name), error instanceof RefusedError && error.message !== "" ? error.message : texts.broken);
    } finally {
      isFinished = true;
      this.isBusy = false;
      dialog.close();
    }
  }

  /** Returns to the live page, because the server closes recordings that no page has viewed for a while. */
  private returnToLive(isLive: boolean): void {
    if (!isLive || readRecordingName(location.href) === null) return;
    history.replaceState(history.state, "", setRecordingName(location.href, null));
    showNotice(strings.recording.gone, strings.recording.goneHint);
  }
}

function hasFiles(event: DragEvent): boolean {
  return event.dataTransfer?.types.includes("Files") ?? false;
}
