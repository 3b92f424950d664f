import { createButton, h } from "../../dom";
import type { ProgramPage } from "../../protocol";
import { addSettings } from "../../requested-settings";
import type { TerminalsState } from "../../state/terminals";
import type { ThemeState } from "../../state/theme";
import { language, strings } from "../../strings";
import type { Panel } from "../panel";

/** The page of a program may download files and open tabs, but not replace this page. */
const SANDBOX_RULES = "allow-scripts allow-same-origin allow-downloads allow-forms allow-modals allow-popups allow-popups-to-escape-sandbox allow-pointer-lock";
const ALLOWED_FEATURES = "fullscreen; microphone; gamepad; clipboard-read; clipboard-write";

/** The pages of programs in the terminals, each in a frame; buttons choose one of several. */
export class ProgramPanel implements Panel {
  readonly id = "program";
  readonly icon = "play";
  readonly element: HTMLElement;
  private readonly emptyNote = h("p", { class: "empty" }, strings.terminal.noProgram);
  private readonly tabs = h("div", { class: "segmented program-tabs", role: "group", aria: { label: strings.terminal.programs } });
  private readonly toolbar: HTMLElement;
  private readonly frameBox = h("div", { class: "program-place" });
  private readonly frames = new Map<number, HTMLIFrameElement>();
  private current: ProgramPage | undefined;

  constructor(
    private readonly state: TerminalsState,
    private readonly theme: ThemeState,
  ) {
    this.toolbar = h("div", { class: "toolbar" }, this.tabs);
    this.element = h("div", { class: "panel program-panel" }, this.emptyNote, this.toolbar, this.frameBox);
    state.programsChanged.on(() => this.update());
    theme.changed.on(() => this.loadFrames());
    this.update();
  }

  /** Removes the pages of programs that ended, and shows the page of a new program. */
  private update(): void {
    const { programs } = this.state;
    for (const [id, frame] of this.frames) {
      if (programs.some((program) => program.id === id)) continue;
      frame.remove();
      this.frames.delete(id);
    }
    if (!programs.some(({ id }) => id === this.current?.id)) this.current = programs.at(-1);
    for (const program of programs) {
      if (this.frames.has(program.id)) continue;
      this.current = program;
      const frame = createFrame(program.title);
      this.frames.set(program.id, frame);
      this.frameBox.append(frame);
    }
    this.emptyNote.hidden = programs.length > 0;
    this.frameBox.hidden = programs.length === 0;
    this.toolbar.hidden = programs.length < 2;
    this.loadFrames();
    this.show();
  }

  /** Loads the pages whose address has changed: it contains the theme. */
  private loadFrames(): void {
    for (const { id, url } of this.state.programs) {
      const frame = this.frames.get(id);
      const address = addSettings(url, { language, theme: this.theme.choice });
      if (frame && frame.src !== address) frame.src = address;
    }
  }

  private show(): void {
    for (const [id, frame] of this.frames) frame.hidden = id !== this.current?.id;
    const tabs = this.state.programs.map((program) => {
      const isCurrent = program.id === this.current?.id;
      const tab = createButton(program.title, () => this.choose(program), isCurrent ? "on" : "", program.title || strings.panels.program);
      tab.setAttribute("aria-pressed", String(isCurrent));
      return tab;
    });
    this.tabs.replaceChildren(...tabs);
  }

  private choose(program: ProgramPage): void {
    this.current = program;
    this.show();
  }
}

function createFrame(title: string): HTMLIFrameElement {
  const frame = h("iframe", { title: title || strings.panels.program });
  frame.setAttribute("sandbox", SANDBOX_RULES);
  frame.allow = ALLOWED_FEATURES;
  return frame;
}
