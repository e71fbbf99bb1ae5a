// The pictures of the draft: which one is looked at, and the way to one more.
import { MOST_VIEWS, current, labels, lookAt, views } from "../draft/draft";
import { addFile } from "../draft/open";
import { messages } from "../messages";
import { Choice } from "../ui/Choice";
import { FileButton } from "../ui/FileButton";

export function Pictures() {
  const { panel } = messages;
  const shown = views.value;
  return (
    <div class="pictures">
      {shown.length > 1 && (
        <Choice
          name="picture"
          legend={panel.pictures}
          quiet
          options={labels.value.map((label, number) => ({ value: String(number), label }))}
          value={String(shown.indexOf(current.value!))}
          onChange={(number) => lookAt(Number(number))}
        />
      )}
      {shown.length < MOST_VIEWS && (
        <FileButton look="link" onChoose={([file]) => void addFile(file!)}>
          {shown.length === 1 ? panel.addSide : panel.addAnother}
        </FileButton>
      )}
    </div>
  );
}
