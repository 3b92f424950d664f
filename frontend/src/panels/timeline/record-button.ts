import { createButton, h } from "../../dom";
import type { RecordedFile } from "../../protocol";
import type { Session } from "../../state/session";
import { strings } from "../../strings";
import { Dialog, showNotice } from "../../widgets/dialog";
import { openMenu, type MenuEntry } from "../../widgets/menu";
import { saveFromUrl } from "../../widgets/save-file";
import { chooseTopics } from "./record-dialog";
import { formatAmount, formatLength, formatSeconds } from "./timeline-text";

/** The number of recorded files that the menu lists. */
const MAX_FILES = 5;

/** The button in the timeline that starts and stops recordings, which the server writes, and saves the history. */
export class RecordButton {
  readonly element: HTMLElement;
  private readonly button: HTMLButtonElement;
  private readonly problem = h("span", { class: "timeline-problem", role: "alert" });

  constructor(private readonly session: Session) {
    const { recording } = session;
    this.button = createButton(strings.recording.record, () => this.onClick(), "timeline-live timeline-record", "");
    this.element = h("span", { class: "timeline-recorder" }, this.problem, this.button);
    recording.changed.on(() => this.show());
    recording.finished.on((file) => this.showFile(file));
    recording.refused.on((reason) => showNotice(strings.recording.refused, reason));
    this.show();
  }

  private show(): void {
    const { isRecording, length, size, savedShare, problem, path, isPossible } = this.session.recording;
    const texts = strings.recording;
    this.element.hidden = !isPossible;
    this.button.classList.toggle("on", isRecording);
    const text = isRecording ? formatAmount(length, size) : savedShare === null ? texts.record : texts.saving(Math.floor(100 * savedShare));
    if (this.button.textContent !== text) this.button.textContent = text;
    const label = isRecording ? texts.stopHint(path) : texts.recordHint;
    this.button.title = label;
    this.button.setAttribute("aria-label", isRecording ? `${texts.stop}: ${text}` : text);
    if (isRecording) this.button.removeAttribute("aria-haspopup");
    else this.button.setAttribute("aria-haspopup", "menu");
    const problemText = isRecording ? "" : problem;
    if (this.problem.textContent !== problemText) this.problem.textContent = this.problem.title = problemText;
  }

  private onClick(): void {
    const { recording } = this.session;
    if (recording.isRecording) recording.stop();
    else openMenu(this.button, this.createEntries());
  }

  private createEntries(): MenuEntry[] {
    const { recording, timeline } = this.session;
    const { extent, mark } = timeline;
    const texts = strings.recording;
    const isSaving = recording.savedShare !== null;
    const historyEntries: MenuEntry[] = [
      {
        label: texts.saveMinutes(extent ? formatLength(extent.end - extent.start) : ""),
        hint: texts.saveHint,
        hasLineAbove: true,
        isDisabled: isSaving || extent === null,
        run: () => recording.save(null, null),
      },
      {
        label: texts.savePart(mark ? formatLength(mark.end - mark.start) : ""),
        hint: mark ? texts.saveHint : texts.markHint,
        isDisabled: isSaving || mark === null,
        run: () => mark && recording.save(mark.start, mark.end),
      },
      { label: texts.markStart, keys: "[", hint: texts.markHint, run: () => timeline.markHere("start") },
      { label: texts.markEnd, keys: "]", hint: texts.markHint, run: () => timeline.markHere("end") },
      ...(mark ? [{ label: texts.unmark, run: () => timeline.setMark(null) }] : []),
    ];
    return [
      { label: texts.all, icon: "record", hint: texts.allHint, run: () => recording.record([]) },
      { label: texts.chosen, run: () => chooseTopics(this.session) },
      ...(timeline.timeline?.live === true ? historyEntries : []),
      ...recording.files.slice(0, MAX_FILES).map(
        (file, index): MenuEntry => ({
          label: texts.fetch(file.name),
          hint: `${file.path}\n${formatAmount(file.length, file.size)}`,
          icon: "download",
          hasLineAbove: index === 0,
          run: () => downloadFile(file),
        }),
      ),
    ];
  }

  /** Shows where a recording was saved, and offers to open or download it. */
  private showFile(file: RecordedFile): void {
    const texts = strings.recording;
    new Dialog(
      texts.made,
      [
        h("p", {}, texts.madeHint(formatAmount(file.length, file.size))),
        file.simulated === null ? "" : h("p", {}, texts.simulated(formatSeconds(file.length), formatSeconds(file.simulated))),
        h("pre", { class: "copyable" }, file.path),
        h("p", {}, texts.openHint),
        h("pre", { class: "copyable" }, `linkwright view ${file.name}`),
      ],
      [
        {
          label: texts.download,
          run: () => {
            downloadFile(file);
            return undefined;
          },
        },
        { label: strings.shell.ok },
        {
          label: texts.openHere,
          isPrimary: true,
          run: () => {
            this.session.recording.viewRequested.emit(file);
            return undefined;
          },
        },
      ],
    ).open();
  }
}

function downloadFile(file: RecordedFile): void {
  saveFromUrl(`${file.name}.mcap`, new URL(file.url, document.baseURI).href);
}
