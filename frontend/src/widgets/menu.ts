import { h } from "../dom";
import { createIcon, type IconName } from "../icons";

/** The distance between a menu and the element that opens it. */
const ANCHOR_GAP_PX = 4;
/** The minimum distances between a menu and the edges of the window. */
const [LEFT_MARGIN_PX, END_MARGIN_PX] = [4, 8];

export interface MenuEntry {
  label: string;
  isChecked?: boolean;
  icon?: IconName;
  /** The keys for the same command, as shown to the user. */
  keys?: string;
  isDisabled?: boolean;
  /** The tooltip, such as the full text of a shortened label. */
  hint?: string;
  /** Whether there is a line above the entry. */
  hasLineAbove?: boolean;
  run: () => void;
}

/** Opens a menu below `anchor`; arrows move, Enter runs, Escape or a click elsewhere closes. */
export function openMenu(anchor: HTMLElement, entries: readonly MenuEntry[]): void {
  const anchorRect = anchor.getBoundingClientRect();
  anchor.setAttribute("aria-expanded", "true");
  showMenu(entries, { x: anchorRect.left, y: anchorRect.bottom + ANCHOR_GAP_PX, bottom: anchorRect.top - ANCHOR_GAP_PX }, anchor, () => anchor.setAttribute("aria-expanded", "false"));
}

/** Opens a menu at a position; the focus returns to `origin` when it closes. */
export function openMenuAt(x: number, y: number, origin: HTMLElement | null, entries: readonly MenuEntry[]): void {
  showMenu(entries, { x, y, bottom: y }, origin);
}

interface MenuPosition {
  x: number;
  y: number;
  /** The lower end of the menu if there is no space below. */
  bottom: number;
}

function showMenu(entries: readonly MenuEntry[], position: MenuPosition, origin: HTMLElement | null, onClosed: () => void = () => undefined): void {
  const close = (returnsFocus: boolean): void => {
    menu.remove();
    document.removeEventListener("pointerdown", onPointerDown, true);
    onClosed();
    if (returnsFocus) origin?.focus();
  };
  const onPointerDown = (event: Event): void => {
    if (!menu.contains(event.target as Node)) close(false);
  };
  const items = entries.map((entry) => createItem(entry, () => close(true)));
  const menu = h("ul", { class: "popup menu", role: "menu" }, ...items);
  const enabledItems = items.filter((item) => item.getAttribute("aria-disabled") !== "true");
  menu.addEventListener("keydown", (event) => {
    if (event.key === "Escape" || event.key === "Tab") close(true);
    else if (!handleKey(enabledItems, event.key)) return;
    event.preventDefault();
    event.stopPropagation();
  });
  menu.addEventListener("focusout", (event) => {
    if (event.relatedTarget instanceof Node && !menu.contains(event.relatedTarget)) close(false);
  });
  menu.addEventListener("contextmenu", (event) => event.preventDefault());
  document.addEventListener("pointerdown", onPointerDown, true);
  // In a modal dialog, only its own elements are reachable.
  (origin?.closest("dialog") ?? document.body).append(menu);
  const spaceBelow = window.innerHeight - position.y;
  if (spaceBelow < menu.offsetHeight + END_MARGIN_PX && position.bottom > spaceBelow) menu.style.bottom = `${window.innerHeight - position.bottom}px`;
  else menu.style.top = `${position.y}px`;
  menu.style.left = `${Math.max(LEFT_MARGIN_PX, Math.min(position.x, window.innerWidth - menu.offsetWidth - END_MARGIN_PX))}px`;
  enabledItems[0]?.focus();
}

function createItem(entry: MenuEntry, close: () => void): HTMLLIElement {
  const item = h("li", {
    role: entry.isChecked === undefined ? "menuitem" : "menuitemcheckbox",
    tabIndex: -1,
    class: entry.hasLineAbove === true ? "separate" : "",
  });
  if (entry.isChecked !== undefined) item.setAttribute("aria-checked", String(entry.isChecked));
  if (entry.isDisabled === true) item.setAttribute("aria-disabled", "true");
  if (entry.hint !== undefined) item.title = entry.hint;
  const entryIcon = entry.isChecked === true ? createIcon("check") : entry.icon ? createIcon(entry.icon) : null;
  item.append(h("span", { class: "menu-check" }, entryIcon), h("span", { class: "menu-label" }, entry.label));
  if (entry.keys !== undefined) item.append(h("kbd", {}, entry.keys));
  item.addEventListener("click", () => {
    if (entry.isDisabled === true) return;
    close();
    entry.run();
  });
  return item;
}

/**
 * Handles a key of a menu and returns whether there was a command for it. A letter moves to the next entry that begins
 * with it.
 */
function handleKey(items: readonly HTMLLIElement[], key: string): boolean {
  const index = items.indexOf(document.activeElement as HTMLLIElement);
  if (key === "ArrowDown") items[(index + 1) % items.length]?.focus();
  else if (key === "ArrowUp") items.at(index - 1)?.focus();
  else if (key === "Home") items[0]?.focus();
  else if (key === "End") items.at(-1)?.focus();
  else if (key === "Enter" || key === " ") items[index]?.click();
  else if (key.length === 1) {
    const letter = key.toLowerCase();
    const searchOrder = [...items.slice(index + 1), ...items.slice(0, index + 1)];
    searchOrder.find((item) => item.querySelector(".menu-label")?.textContent.toLowerCase().startsWith(letter))?.focus();
  } else return false;
  return true;
}
