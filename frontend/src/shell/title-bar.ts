import { createButton, h } from "../dom";
import { createIcon } from "../icons";
import type { Dock } from "../panels/dock/dock";
import type { Session } from "../state/session";
import { THEME_CHOICES, type ThemeState } from "../state/theme";
import { changeLanguage, strings } from "../strings";
import { createLogo } from "../widgets/logo";
import { openMenu, type MenuEntry } from "../widgets/menu";
import { formatShortcut, SHORTCUTS } from "../widgets/shortcuts";
import { formatEdit, type FileCommands } from "./file-commands";
import { addressFor } from "./own-displays";
import type { RecordingDrop } from "./recording-drop";
import type { ShareMenu } from "./share-menu";

/** The head of the page: menus, the configuration file, and commands for the whole page. */
export class TitleBar {
  readonly element: HTMLElement;
  private readonly titleText = h("span", { class: "document-title" });
  private readonly fileText = h("span", { class: "file-name" });
  private readonly undoButton: HTMLButtonElement;
  private readonly redoButton: HTMLButtonElement;
  private programTitle = "";

  constructor(
    private readonly session: Session,
    private readonly dock: Dock,
    private readonly files: FileCommands,
    private readonly recordings: RecordingDrop,
    theme: ThemeState,
    share: ShareMenu,
  ) {
    const texts = strings.shell;
    const { configuration } = session;
    this.undoButton = createButton(texts.undo, () => configuration.undo(), "tool bare", createIcon("undo"));
    this.redoButton = createButton(texts.redo, () => configuration.redo(), "tool bare", createIcon("redo"));
    const menus = [
      createMenuButton(texts.file, () => this.createFileMenu()),
      createMenuButton(texts.panels, () => this.createPanelsMenu()),
      createMenuButton(strings.sharing.share, () => share.createEntries()),
    ];
    bindArrowKeys(menus);
    this.element = h(
      "header",
      { class: "title-bar" },
      createLogo(),
      h("span", { class: "brand" }, "Linkwright"),
      h("nav", { class: "menu-bar", aria: { label: texts.menu } }, ...menus),
      this.undoButton,
      this.redoButton,
      this.fileText,
      this.titleText,
      h("span", { class: "spacer" }),
      share.element,
      this.createOwnSwitch(),
      createThemeButton(theme),
      createButton(
        texts.languageHint,
        changeLanguage,
        "tool language-button",
        createIcon("language"),
        texts.language,
      ),
    );
    configuration.changed.on(() => this.update());
    session.greeted.on(({ title, version }) => {
      this.programTitle = title;
      this.element.dataset["version"] = version;
      this.update();
    });
    this.update();
  }

  private update(): void {
    const texts = strings.shell;
    const { current, fileName } = this.session.configuration;
    const name = fileName ?? texts.untitled;
    this.fileText.replaceChildren(name, current.unsaved ? h("span", { class: "unsaved", title: texts.unsaved }, "●") : "");
    this.fileText.title = `${current.path ?? texts.untitled}${current.unsaved ? ` (${texts.unsaved})` : ""}`;
    this.titleText.textContent = this.programTitle;
    document.title = `${current.unsaved ? "● " : ""}${this.programTitle || name} - Linkwright`;
    this.undoButton.disabled = current.undo === null;
    this.redoButton.disabled = current.redo === null;
    setLabel(this.undoButton, current.undo ? texts.undoing(formatEdit(current.undo)) : texts.undo, formatShortcut(SHORTCUTS.undo));
    setLabel(this.redoButton, current.redo ? texts.redoing(formatEdit(current.redo)) : texts.redo, formatShortcut(SHORTCUTS.redo));
  }

  private createFileMenu(): MenuEntry[] {
    const texts = strings.shell;
    const { files } = this;
    const { current } = this.session.configuration;
    return [
      { label: texts.newFile, icon: "file", run: () => files.createFile() },
      { label: texts.open, icon: "open", keys: formatShortcut(SHORTCUTS.open), run: () => files.chooseFile() },
      { label: texts.openLocal, icon: "upload", run: () => files.chooseLocal() },
      { label: strings.recording.open, hint: strings.recording.openFileHint, icon: "play", run: () => this.recordings.choose() },
      { label: texts.save, icon: "save", keys: formatShortcut(SHORTCUTS.save), hasLineAbove: true, run: () => files.save() },
      { label: texts.saveAs, keys: formatShortcut(SHORTCUTS.saveAs), run: () => files.saveAs() },
      { label: texts.download, icon: "download", run: () => files.download() },
      {
        label: texts.revert,
        isDisabled: current.path === null || !current.unsaved,
        hasLineAbove: true,
        run: () => files.revert(),
      },
      ...current.recent.map((path, index) => ({
        label: shortenLongPath(path),
        hint: path,
        icon: "recent" as const,
        hasLineAbove: index === 0,
        run: () => files.open(path),
      })),
    ];
  }

  private createPanelsMenu(): MenuEntry[] {
    const { dock } = this;
    return [
      ...dock.ids
        .filter((id) => id !== "joints" || this.session.joints.controls !== null)
        .filter((id) => id !== "terminal" || this.session.terminals.isAvailable)
        .filter((id) => id !== "program" || this.session.terminals.programs.length > 0)
        .filter((id) => id !== "turtlesim" || this.session.turtlesim.simulators.length > 0)
        .map((id) => ({
          label: strings.panels[id],
          isChecked: dock.isOpen(id),
          run: () => (dock.isOpen(id) ? dock.close(id) : dock.open(id)),
        })),
      { label: strings.shell.resetLayout, hasLineAbove: true, icon: "reset", run: () => dock.reset() },
    ];
  }

  private createOwnSwitch(): HTMLElement {
    const texts = strings.shell;
    const { configuration } = this.session;
    const choose = (isOwn: boolean) => (): void => {
      if (isOwn !== configuration.current.is_own) location.assign(addressFor(location.href, isOwn));
    };
    const sharedButton = createButton(texts.sharedDisplays, choose(false), "", createIcon("shared"), texts.shared);
    const ownButton = createButton(texts.ownHint, choose(true), "", createIcon("own"), texts.own);
    const show = (): void => {
      for (const [element, isPressed] of [
        [sharedButton, !configuration.current.is_own],
        [ownButton, configuration.current.is_own],
      ] as const) {
        element.classList.toggle("on", isPressed);
        element.setAttribute("aria-pressed", String(isPressed));
      }
    };
    configuration.changed.on(show);
    show();
    return h("div", { class: "segmented own-switch", role: "group", aria: { label: texts.displays } }, sharedButton, ownButton);
  }
}

function setLabel(element: HTMLButtonElement, name: string, keys: string): void {
  element.title = `${name} (${keys})`;
  element.setAttribute("aria-label", name);
}

function createMenuButton(label: string, createEntries: () => MenuEntry[]): HTMLButtonElement {
  const element = createButton(label, () => openMenu(element, createEntries()), "tool menu-button", label);
  element.setAttribute("aria-haspopup", "menu");
  element.setAttribute("aria-expanded", "false");
  element.removeAttribute("title");
  return element;
}

/** Moves between menus with left and right, and opens one with down. */
function bindArrowKeys(menus: readonly HTMLButtonElement[]): void {
  for (const [index, menu] of menus.entries()) {
    menu.addEventListener("keydown", (event) => {
      if (event.key === "ArrowRight") menus[(index + 1) % menus.length]?.focus();
      else if (event.key === "ArrowLeft") menus.at(index - 1)?.focus();
      else if (event.key === "ArrowDown") menu.click();
      else return;
      event.preventDefault();
    });
  }
}

function shortenLongPath(path: string): string {
  return path.length <= 60 ? path : `…${path.slice(-58)}`;
}

/** Returns the button that shows the theme, with a menu to choose one. */
function createThemeButton(theme: ThemeState): HTMLButtonElement {
  const texts = strings.shell;
  const choose = (): void => {
    const entries = THEME_CHOICES.map((choice) => ({
      label: texts.themes[choice],
      isChecked: theme.choice === choice,
      run: () => theme.choose(choice),
    }));
    openMenu(element, entries);
  };
  const element = createButton(texts.theme, choose, "tool bare theme-button", createIcon("system"));
  element.setAttribute("aria-haspopup", "menu");
  const show = (): void => element.replaceChildren(createIcon(theme.theme === "light" ? "light" : "dark"));
  theme.changed.on(show);
  show();
  return element;
}
