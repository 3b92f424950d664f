import type { IconName } from "../icons";
import type { PropertyKind, PropertyValue } from "../protocol";
import type { ShownLevel } from "../state/displays";

/** A row of a property tree. */
export interface TreeItem {
  /** Unique within its tree, and the same in every refresh. */
  readonly key: string;
  readonly name: string;
  readonly kind: PropertyKind;
  readonly value: PropertyValue;
  readonly description: string;
  readonly icon?: IconName;
  /** Sets the color of the row, and the icon if `showsLevelIcon` is true. */
  readonly level?: ShownLevel;
  readonly showsLevelIcon?: boolean;
  readonly isStrong?: boolean;
  readonly isMuted?: boolean;
  /** The tooltip of the name; the name by default. */
  readonly hint?: string;
  /** Whether the name fills the whole row. */
  readonly isWide?: boolean;
  /** Whether several rows of this kind can be selected together. */
  readonly isMultiSelectable?: boolean;
  /** A small text after the name. */
  readonly badge?: string;
  readonly options?: readonly string[];
  readonly minimum?: number | null;
  readonly maximum?: number | null;
  readonly isReadOnly?: boolean;
  /** Whether the row is unfolded until the user folds it. */
  readonly isExpanded?: boolean;
  /** Overrides the user's choice: a search unfolds the row because it found a row below it. */
  readonly isForcedOpen?: boolean;
  readonly children?: () => readonly TreeItem[];
  /** Called on a double click on the name, or Enter on the row. */
  readonly activate?: () => void;
  /** Whether the value follows the scene, and is read each time it is shown. */
  readonly isLive?: boolean;
  /** Requests the names to choose from, for a row of the kind `topic`. */
  readonly requestNames?: (show: (names: readonly string[]) => void) => void;
  /** Applies an edit; a row without it is read-only. */
  readonly set?: (value: PropertyValue) => void;
}

/** The value part of a row. */
export interface Editor {
  readonly element: HTMLElement;
  /** Shows the item's value, unless the user is editing it. */
  show(item: TreeItem): void;
  /** Takes the focus; returns false if there is nothing to edit. */
  focus(): boolean;
  /** Toggles a box, when Space is pressed on the row. */
  toggle?(): void;
}
