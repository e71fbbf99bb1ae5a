// A button, or a link, that lets files be chosen.
import type { ComponentChildren } from "preact";

interface Props {
  readonly look?: "button" | "button is-small" | "button is-primary" | "link";
  readonly accept?: string;
  readonly multiple?: boolean;
  /** What a screen reader says, where that is more than is written. */
  readonly named?: string;
  readonly onChoose: (files: readonly File[]) => void;
  readonly children: ComponentChildren;
}

export function FileButton({ look = "button is-small", accept = "image/*", multiple = false, named, onChoose, children }: Props) {
  return (
    <label class={look}>
      {children}
      <input
        class="unseen"
        type="file"
        accept={accept}
        multiple={multiple}
        aria-label={named}
        onChange={(event) => {
          const files = [...(event.currentTarget.files ?? [])];
          // The same file may be chosen again.
          event.currentTarget.value = "";
          if (files.length > 0) onChoose(files);
        }}
      />
    </label>
  );
}
