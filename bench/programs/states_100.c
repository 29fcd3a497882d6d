/* The same as states_100.st. */
#include <stdint.h>

typedef struct {
  int32_t input, value;
  uint32_t parts;
  int16_t state;
} Sequence;

static Sequence machines[20];
static uint32_t seed = 1, checksum;

static void sequence(Sequence* m) {
  switch (m->state) {
    case 0:
      m->value += 1;
      m->state = m->input > 20 ? 11 : 29;
      break;
    case 1:
      m->value -= m->input;
      m->state = m->input > 27 ? 48 : 82;
      break;
    case 2:
      m->parts += 1;
      m->state = m->input > 34 ? 85 : 35;
      break;
    case 3:
      m->value *= 9;
      m->state = m->input > 41 ? 22 : 88;
      break;
    case 4:
      m->value += 5;
      m->state = m->input > 48 ? 59 : 41;
      break;
    case 5:
      m->value -= m->input;
      m->state = m->input > 55 ? 96 : 94;
      break;
    case 6:
      m->parts += 1;
      m->state = m->input > 62 ? 33 : 47;
      break;
    case 7:
      m->value *= 7;
      m->state = m->input > 69 ? 70 : 0;
      break;
    case 8:
      m->value += 9;
      m->state = m->input > 76 ? 7 : 53;
      break;
    case 9:
      m->value -= m->input;
      m->state = m->input > 83 ? 44 : 6;
      break;
    case 10:
      m->parts += 1;
      m->state = m->input > 90 ? 81 : 59;
      break;
    case 11:
      m->value *= 5;
      m->state = m->input > 97 ? 18 : 12;
      break;
    case 12:
      m->value += 13;
      m->state = m->input > 104 ? 55 : 65;
      break;
    case 13:
      m->value -= m->input;
      m->state = m->input > 111 ? 92 : 18;
      break;
    case 14:
      m->parts += 1;
      m->state = m->input > 21 ? 29 : 71;
      break;
    case 15:
      m->value *= 3;
      m->state = m->input > 28 ? 66 : 24;
      break;
    case 16:
      m->value += 17;
      m->state = m->input > 35 ? 3 : 77;
      break;
    case 17:
      m->value -= m->input;
      m->state = m->input > 42 ? 40 : 30;
      break;
    case 18:
      m->parts += 1;
      m->state = m->input > 49 ? 77 : 83;
      break;
    case 19:
      m->value *= 11;
      m->state = m->input > 56 ? 14 : 36;
      break;
    case 20:
      m->value += 21;
      m->state = m->input > 63 ? 51 : 89;
      break;
    case 21:
      m->value -= m->input;
      m->state = m->input > 70 ? 88 : 42;
      break;
    case 22:
      m->parts += 1;
      m->state = m->input > 77 ? 25 : 95;
      break;
    case 23:
      m->value *= 9;
      m->state = m->input > 84 ? 62 : 48;
      break;
    case 24:
      m->value += 25;
      m->state = m->input > 91 ? 99 : 1;
      break;
    case 25:
      m->value -= m->input;
      m->state = m->input > 98 ? 36 : 54;
      break;
    case 26:
      m->parts += 1;
      m->state = m->input > 105 ? 73 : 7;
      break;
    case 27:
      m->value *= 7;
      m->state = m->input > 112 ? 10 : 60;
      break;
    case 28:
      m->value += 29;
      m->state = m->input > 22 ? 47 : 13;
      break;
    case 29:
      m->value -= m->input;
      m->state = m->input > 29 ? 84 : 66;
      break;
    case 30:
      m->parts += 1;
      m->state = m->input > 36 ? 21 : 19;
      break;
    case 31:
      m->value *= 5;
      m->state = m->input > 43 ? 58 : 72;
      break;
    case 32:
      m->value += 33;
      m->state = m->input > 50 ? 95 : 25;
      break;
    case 33:
      m->value -= m->input;
      m->state = m->input > 57 ? 32 : 78;
      break;
    case 34:
      m->parts += 1;
      m->state = m->input > 64 ? 69 : 31;
      break;
    case 35:
      m->value *= 3;
      m->state = m->input > 71 ? 6 : 84;
      break;
    case 36:
      m->value += 37;
      m->state = m->input > 78 ? 43 : 37;
      break;
    case 37:
      m->value -= m->input;
      m->state = m->input > 85 ? 80 : 90;
      break;
    case 38:
      m->parts += 1;
      m->state = m->input > 92 ? 17 : 43;
      break;
    case 39:
      m->value *= 11;
      m->state = m->input > 99 ? 54 : 96;
      break;
    case 40:
      m->value += 41;
      m->state = m->input > 106 ? 91 : 49;
      break;
    case 41:
      m->value -= m->input;
      m->state = m->input > 113 ? 28 : 2;
      break;
    case 42:
      m->parts += 1;
      m->state = m->input > 23 ? 65 : 55;
      break;
    case 43:
      m->value *= 9;
      m->state = m->input > 30 ? 2 : 8;
      break;
    case 44:
      m->value += 45;
      m->state = m->input > 37 ? 39 : 61;
      break;
    case 45:
      m->value -= m->input;
      m->state = m->input > 44 ? 76 : 14;
      break;
    case 46:
      m->parts += 1;
      m->state = m->input > 51 ? 13 : 67;
      break;
    case 47:
      m->value *= 7;
      m->state = m->input > 58 ? 50 : 20;
      break;
    case 48:
      m->value += 49;
      m->state = m->input > 65 ? 87 : 73;
      break;
    case 49:
      m->value -= m->input;
      m->state = m->input > 72 ? 24 : 26;
      break;
    case 50:
      m->parts += 1;
      m->state = m->input > 79 ? 61 : 79;
      break;
    case 51:
      m->value *= 5;
      m->state = m->input > 86 ? 98 : 32;
      break;
    case 52:
      m->value += 53;
      m->state = m->input > 93 ? 35 : 85;
      break;
    case 53:
      m->value -= m->input;
      m->state = m->input > 100 ? 72 : 38;
      break;
    case 54:
      m->parts += 1;
      m->state = m->input > 107 ? 9 : 91;
      break;
    case 55:
      m->value *= 3;
      m->state = m->input > 114 ? 46 : 44;
      break;
    case 56:
      m->value += 57;
      m->state = m->input > 24 ? 83 : 97;
      break;
    case 57:
      m->value -= m->input;
      m->state = m->input > 31 ? 20 : 50;
      break;
    case 58:
      m->parts += 1;
      m->state = m->input > 38 ? 57 : 3;
      break;
    case 59:
      m->value *= 11;
      m->state = m->input > 45 ? 94 : 56;
      break;
    case 60:
      m->value += 61;
      m->state = m->input > 52 ? 31 : 9;
      break;
    case 61:
      m->value -= m->input;
      m->state = m->input > 59 ? 68 : 62;
      break;
    case 62:
      m->parts += 1;
      m->state = m->input > 66 ? 5 : 15;
      break;
    case 63:
      m->value *= 9;
      m->state = m->input > 73 ? 42 : 68;
      break;
    case 64:
      m->value += 65;
      m->state = m->input > 80 ? 79 : 21;
      break;
    case 65:
      m->value -= m->input;
      m->state = m->input > 87 ? 16 : 74;
      break;
    case 66:
      m->parts += 1;
      m->state = m->input > 94 ? 53 : 27;
      break;
    case 67:
      m->value *= 7;
      m->state = m->input > 101 ? 90 : 80;
      break;
    case 68:
      m->value += 69;
      m->state = m->input > 108 ? 27 : 33;
      break;
    case 69:
      m->value -= m->input;
      m->state = m->input > 115 ? 64 : 86;
      break;
    case 70:
      m->parts += 1;
      m->state = m->input > 25 ? 1 : 39;
      break;
    case 71:
      m->value *= 5;
      m->state = m->input > 32 ? 38 : 92;
      break;
    case 72:
      m->value += 73;
      m->state = m->input > 39 ? 75 : 45;
      break;
    case 73:
      m->value -= m->input;
      m->state = m->input > 46 ? 12 : 98;
      break;
    case 74:
      m->parts += 1;
      m->state = m->input > 53 ? 49 : 51;
      break;
    case 75:
      m->value *= 3;
      m->state = m->input > 60 ? 86 : 4;
      break;
    case 76:
      m->value += 77;
      m->state = m->input > 67 ? 23 : 57;
      break;
    case 77:
      m->value -= m->input;
      m->state = m->input > 74 ? 60 : 10;
      break;
    case 78:
      m->parts += 1;
      m->state = m->input > 81 ? 97 : 63;
      break;
    case 79:
      m->value *= 11;
      m->state = m->input > 88 ? 34 : 16;
      break;
    case 80:
      m->value += 81;
      m->state = m->input > 95 ? 71 : 69;
      break;
    case 81:
      m->value -= m->input;
      m->state = m->input > 102 ? 8 : 22;
      break;
    case 82:
      m->parts += 1;
      m->state = m->input > 109 ? 45 : 75;
      break;
    case 83:
      m->value *= 9;
      m->state = m->input > 116 ? 82 : 28;
      break;
    case 84:
      m->value += 85;
      m->state = m->input > 26 ? 19 : 81;
      break;
    case 85:
      m->value -= m->input;
      m->state = m->input > 33 ? 56 : 34;
      break;
    case 86:
      m->parts += 1;
      m->state = m->input > 40 ? 93 : 87;
      break;
    case 87:
      m->value *= 7;
      m->state = m->input > 47 ? 30 : 40;
      break;
    case 88:
      m->value += 89;
      m->state = m->input > 54 ? 67 : 93;
      break;
    case 89:
      m->value -= m->input;
      m->state = m->input > 61 ? 4 : 46;
      break;
    case 90:
      m->parts += 1;
      m->state = m->input > 68 ? 41 : 99;
      break;
    case 91:
      m->value *= 5;
      m->state = m->input > 75 ? 78 : 52;
      break;
    case 92:
      m->value += 93;
      m->state = m->input > 82 ? 15 : 5;
      break;
    case 93:
      m->value -= m->input;
      m->state = m->input > 89 ? 52 : 58;
      break;
    case 94:
      m->parts += 1;
      m->state = m->input > 96 ? 89 : 11;
      break;
    case 95:
      m->value *= 3;
      m->state = m->input > 103 ? 26 : 64;
      break;
    case 96:
      m->value += 97;
      m->state = m->input > 110 ? 63 : 17;
      break;
    case 97:
      m->value -= m->input;
      m->state = m->input > 20 ? 0 : 70;
      break;
    case 98:
      m->parts += 1;
      m->state = m->input > 27 ? 37 : 23;
      break;
    case 99:
      m->value *= 11;
      m->state = m->input > 34 ? 74 : 76;
      break;
  }
}

void states_100_scan(int64_t now_ns) {
  (void)now_ns;
  for (int i = 0; i <= 19; ++i) {
    seed = seed * 1664525u + 1013904223u;
    machines[i].input = (int32_t)(seed / 16777216u);
    sequence(&machines[i]);
    checksum = checksum * 31u + (uint32_t)machines[i].value + machines[i].parts;
  }
}

uint32_t states_100_checksum(void) { return checksum; }
