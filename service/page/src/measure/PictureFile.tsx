// A picture chosen as a file, or taken by the phone's own camera.

interface Props {
  readonly label: string;
  /** What a screen reader says: which of the places it is for. */
  readonly named: string;
  /** Whether the phone's camera is opened, not its gallery. */
  readonly camera?: boolean;
  readonly onChoose: (file: File, name: string) => void;
}

export function PictureFile({ label, named, camera, onChoose }: Props) {
  return (
    <label class="button">
      {label}
      <input
        class="unseen"
        type="file"
        accept="image/*"
        aria-label={named}
        {...(camera ? { capture: "environment" } : {})}
        onChange={(event) => {
          const file = event.currentTarget.files?.[0];
          event.currentTarget.value = "";
          if (file) onChoose(file, file.name);
        }}
      />
    </label>
  );
}
