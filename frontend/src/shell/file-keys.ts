import type { ConfigurationState } from "../state/configuration";
import { matchesShortcut, SHORTCUTS } from "../widgets/shortcuts";
import type { FileCommands } from "./file-commands";

/** The part of the editor of source files that keys need. */
interface Sources {
  /** Whether the editor shows files. */
  readonly isEditing: boolean;
  readonly hasUnsaved: boolean;
  saveAll(): void;
}

/** The location of the focus, and the unsaved changes. */
interface SaveContext {
  readonly focus: "editor" | "configuration" | "elsewhere";
  readonly isEditing: boolean;
  readonly hasUnsavedSources: boolean;
  readonly isConfigurationUnsaved: boolean;
}

/**
 * Returns what the key of *Save* saves: the files of the editor or of the panel that has the focus; with the focus
 * elsewhere, the changed source files, otherwise the configuration. While source files are edited, the key does not ask
 * for the name of an unchanged configuration.
 */
export function chooseSaveTarget({ focus, isEditing, hasUnsavedSources, isConfigurationUnsaved }: SaveContext): "sources" | "configuration" {
  if (focus === "configuration") return "configuration";
  return focus === "editor" || hasUnsavedSources || (isEditing && !isConfigurationUnsaved) ? "sources" : "configuration";
}

/**
 * Binds the keys of the File menu, and undo. They work everywhere except in dialogs and the terminal; in a text field,
 * undo belongs to the field, and in the editor all keys but *Save* to the editor.
 *
 * @param panels - the panels of the configuration.
 */
export function bindFileKeys(configuration: ConfigurationState, files: FileCommands, sources: Sources, panels: readonly HTMLElement[]): void {
  const save = (target: Element | null): void => {
    const isInEditor = target?.matches(".source-editor *") === true;
    const isInPanel = panels.some((panel) => panel.contains(target));
    const saveTarget = chooseSaveTarget({
      focus: isInEditor ? "editor" : isInPanel ? "configuration" : "elsewhere",
      isEditing: sources.isEditing,
      hasUnsavedSources: sources.hasUnsaved,
      isConfigurationUnsaved: configuration.current.unsaved,
    });
    if (saveTarget === "sources") sources.saveAll();
    else files.save();
  };
  const bindings = [
    { shortcut: SHORTCUTS.save, run: save, worksInEditor: true },
    { shortcut: SHORTCUTS.saveAs, run: () => files.saveAs() },
    { shortcut: SHORTCUTS.open, run: () => files.chooseFile() },
    { shortcut: SHORTCUTS.undo, run: () => configuration.undo(), isLeftToTextFields: true },
    { shortcut: SHORTCUTS.redo, run: () => configuration.redo(), isLeftToTextFields: true },
    { shortcut: SHORTCUTS.redoToo, run: () => configuration.redo(), isLeftToTextFields: true },
  ];
  const onKeyDown = (event: KeyboardEvent): void => {
    const target = event.target instanceof Element ? event.target : null;
    const binding = bindings.find(({ shortcut }) => matchesShortcut(event, shortcut));
    if (!binding || target?.closest("dialog, .terminal-screen")) return;
    if (binding.worksInEditor !== true && target?.closest(".source-editor")) return;
    if (binding.isLeftToTextFields === true && target?.matches("input[type=text], textarea")) return;
    event.preventDefault();
    event.stopPropagation();
    binding.run(target);
  };
  // Capture the event: a field that is edited stops keys from bubbling, and the browser would save the page.
  document.addEventListener("keydown", onKeyDown, true);
}
