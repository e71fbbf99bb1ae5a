from fitter.training.report.text_tables import NOTE_WIDTH, note_lines, table_lines


def test_numbers_line_up_under_their_heads():
    lines = table_lines("sizes", ("", "cm"), [("waist", "81.50"), ("a wider name", "9.00")])
    assert lines == (
        "  sizes",
        "                     cm",
        "    waist         81.50",
        "    a wider name   9.00",
    )


def test_a_table_without_heads_has_no_line_for_them():
    assert table_lines("sizes", ("", ""), [("waist", "81.5")]) == ("  sizes", "    waist  81.5")


def test_notes_are_wrapped_and_keep_their_words():
    text = "Every word of a long note is kept, whatever the width. " * 5
    lines = note_lines(text)
    assert len(lines) > 2
    assert max(map(len, lines)) <= NOTE_WIDTH + 4
    assert " ".join(line.strip() for line in lines) == text.strip()
