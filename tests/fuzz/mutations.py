"""Ways to spoil words, texts and bytes. `chance` is a random.Random."""

ODD_WORDS = (
    "0 -0 1 -1 2 3 17 1e-300 -1e300 1e308 4e-324 nan inf -inf 1e400 0x10 1, ,1 1,2 1,2,3 1;2 2,6e-3 1e 1.5.2 abc "
    "true false yes none all 99999999999999999999 2147483647 2147483648 -2147483648 % # ! @ '' "
    "\u00e9 \u6f22 :x ascii: ../x . / "
    "$HOME ~ * a=b -- - _ ., +5 1d3 1_000"
).split(" ") + ["", " ", "\t", "a b", "x" * 300, "1" * 400]

ODD_NAMES = (
    "-grid_m -load -loadn -load_n=5 --grid_n -help -version -log_view -options_left -info -malloc_dump -prefix_push "
    "-options_file -history -output -checkpoint -restart -steps -normal_type -tangential_type -normal_max_it "
    "-tangential_max_it -normal_rtol -tangential_rtol -normal_view -tangential_converged_reason -coupling "
    "-coupling_rtol -elasticity -disp_z -disp_x -rot_z -load_mz -load_mx -friction -friction_file "
    "-gap_file -gap_rough_file -gap_type "
    "-max_walltime -checkpoint_every -output_every -output_compress -output_chunk -allow_edge_contact "
    "-memory_check -python -fp_trap -log_trace -options_view -normal_monitor -tangential_levels -normal_levels"
).split()


def spoil_words(chance, words):
    """Changes a few words of a command line."""
    words = list(words)
    for _ in range(chance.choice((1, 1, 1, 2, 4))):
        k = chance.randrange(len(words))
        how = chance.randrange(7)
        if how == 0:
            words[k] = chance.choice(ODD_WORDS)
        elif how == 1:
            del words[k]
        elif how == 2:
            words.insert(k, chance.choice(ODD_WORDS))
        elif how == 3:
            words += [chance.choice(ODD_NAMES), chance.choice(ODD_WORDS)]
        elif how == 4:
            words.insert(k, chance.choice(ODD_NAMES))
        elif how == 5:
            words[k] = spoil_text(chance, words[k]) if words[k] else "x"
        else:
            other = chance.randrange(len(words))
            words[k], words[other] = words[other], words[k]
        words = words or ["-grid_n"]
    return [word.replace("\0", "") for word in words]


def spoil_text(chance, text):
    k = chance.randrange(len(text) + 1)
    how = chance.randrange(4)
    if how == 0:
        return text[:k] + chance.choice(ODD_WORDS) + text[k:]
    if how == 1:
        return text[:k] + text[k + chance.randint(1, 4) :]
    if how == 2:
        return text[:k] + chr(chance.choice((9, 10, 13, 32, 34, 39, 44, 59, 92, 127, 233, 0xFEFF))) + text[k:]
    return text[:k] + text[k:] + text[chance.randrange(len(text) + 1) :]


def spoil_table(chance, text):
    """Changes a few fields or lines of a table of numbers."""
    lines = text.split("\n")
    for _ in range(chance.choice((1, 1, 1, 2, 3))):
        k = chance.randrange(len(lines))
        how = chance.randrange(6)
        if how == 0:
            lines[k] = spoil_text(chance, lines[k])
        elif how == 1:
            lines.insert(k, chance.choice(lines))
        elif how == 2 and len(lines) > 2:
            del lines[k]
        elif how == 3:
            lines.insert(k, chance.choice(("", "#", ",", ",,,", "# x, y", "time", "\ufefftime", "1;2;3", "1\t2\t3")))
        else:
            fields = lines[k].split(",")
            fields[chance.randrange(len(fields))] = chance.choice(ODD_WORDS)
            lines[k] = ",".join(fields)
    return "\n".join(lines)


def spoil_bytes(chance, data):
    """Changes bits or stretches of a file's bytes, or its length; often near its start, where HDF5's structure is."""
    data = bytearray(data)
    for _ in range(chance.choice((1, 1, 1, 2, 8, 50))):
        size = len(data)
        if not size:
            break
        k = chance.randrange(min(size, chance.choice((96, 1024, 8192, size))))
        how = chance.randrange(8)
        if how < 3:
            data[k] ^= 1 << chance.randrange(8)
        elif how == 3:
            data[k] = chance.choice((0, 1, 127, 128, 255))
        elif how == 4:
            count = chance.randint(1, 64)
            data[k : k + count] = chance.choice((b"\0", b"\xff")) * min(count, size - k)
        elif how == 5:
            count = chance.randint(1, 64)
            data[k : k + count] = bytes(chance.randrange(256) for _ in range(min(count, size - k)))
        elif how == 6:
            other = chance.randrange(size)
            count = min(chance.randint(1, 512), size - k, size - other)
            data[k : k + count] = data[other : other + count]
        elif chance.random() < 0.5:
            del data[chance.randrange(size) :]
        else:
            data += bytes(chance.randint(1, 4096))
    return bytes(data)
