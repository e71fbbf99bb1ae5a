// A file to be chosen by a button.
interface Props {
  readonly label: string;
  readonly accept: string;
  readonly onChoose: (file: File) => void;
}

export function FileChoice({ label, accept, onChoose }: Props) {
  return (
    <label class="button is-small">
      {label}
      <input
        class="unseen"
        type="file"
        accept={accept}
        onChange={(event) => {
          const file = event.currentTarget.files?.[0];
          event.currentTarget.value = "";
          if (file) onChoose(file);
        }}
      />
    </label>
  );
}
