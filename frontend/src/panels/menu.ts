import { h } from "../dom";
import { icon } from "../icons";

export interface MenuEntry {
  label: string;
  checked?: boolean;
  run: () => void;
}

/** Opens a menu below `anchor`; arrows move, Enter runs, Escape or a click elsewhere closes. */
export function openMenu(anchor: HTMLElement, entries: readonly MenuEntry[]): void {
  const items = entries.map((entry) => {
    const item = h("li", { role: entry.checked === undefined ? "menuitem" : "menuitemcheckbox", tabIndex: -1 });
    if (entry.checked !== undefined) item.setAttribute("aria-checked", String(entry.checked));
    item.append(h("span", { class: "menu-check" }, entry.checked === true ? icon("check") : null), entry.label);
    item.addEventListener("click", () => {
      close();
      entry.run();
    });
    return item;
  });
  const menu = h("ul", { class: "popup menu", role: "menu" }, ...items);
  const close = (): void => {
    menu.remove();
    document.removeEventListener("pointerdown", outside, true);
  };
  const outside = (event: Event): void => {
    if (!menu.contains(event.target as Node)) close();
  };
  menu.addEventListener("keydown", (event) => {
    const index = items.indexOf(document.activeElement as HTMLLIElement);
    if (event.key === "ArrowDown") items[(index + 1) % items.length]?.focus();
    else if (event.key === "ArrowUp") items.at(index - 1)?.focus();
    else if (event.key === "Enter" || event.key === " ") items[index]?.click();
    else if (event.key === "Escape") {
      close();
      anchor.focus();
    } else return;
    event.preventDefault();
    event.stopPropagation();
  });
  document.addEventListener("pointerdown", outside, true);
  document.body.append(menu);
  const box = anchor.getBoundingClientRect();
  menu.style.top = `${box.bottom + 4}px`;
  menu.style.left = `${Math.min(box.left, window.innerWidth - menu.offsetWidth - 8)}px`;
  items[0]?.focus();
}
