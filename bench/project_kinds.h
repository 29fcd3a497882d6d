// The kinds of function blocks that project.cc writes. `@` is the number of a block, `$` a
// constant, `%` the number of the area whose global variables a call uses.
#pragma once

struct ProjectKind {
  const char* source;
  const char* instance;
  const char* call;
};

inline constexpr ProjectKind kProjectKinds[] = {
    {R"((* A drive with interlocks, run feedback and a start delay. *)
FUNCTION_BLOCK Drive@
VAR_INPUT
  Start    : BOOL;
  Stop     : BOOL;
  Tripped  : BOOL;
  Running  : BOOL;  (* contactor's answer *)
  Reset    : BOOL;
END_VAR
VAR_OUTPUT
  Contactor : BOOL;
  Fault     : BOOL;
  Code      : INT;
  Starts    : UDINT;
  Hours     : REAL;
END_VAR
VAR
  Delay    : TON;
  Feedback : TON;
  Edge     : R_TRIG;
  Request  : BOOL;
END_VAR
  IF Stop OR Fault THEN
    Request := FALSE;
  ELSIF Start THEN
    Request := TRUE;
  END_IF;
  Delay(IN := Request, PT := T#$ms);
  Contactor := Delay.Q AND NOT Tripped;
  Edge(CLK := Contactor);
  IF Edge.Q THEN
    Starts := Starts + 1;
  END_IF;
  Feedback(IN := Contactor AND NOT Running, PT := T#$ms);
  IF Tripped THEN
    Fault := TRUE;
    Code := $;
  ELSIF Feedback.Q THEN
    Fault := TRUE;
    Code := $;
  ELSIF Reset THEN
    Fault := FALSE;
    Code := 0;
  END_IF;
  IF Running THEN
    Hours := Hours + 0.000$;
  END_IF;
END_FUNCTION_BLOCK

)",
     "  Drive@_1 : Drive@;\n",
     R"(  Drive@_1(Start := Area%_Enable, Stop := Area%_Stop, Tripped := FALSE, Running := Area%_Ready,
         Reset := Area%_Reset);
  IF Drive@_1.Fault THEN
    Area%_Ready := FALSE;
  END_IF;
)"},
    {R"((* A valve with two end positions. *)
FUNCTION_BLOCK Valve@
VAR_INPUT
  Open     : BOOL;
  IsOpen   : BOOL;
  IsClosed : BOOL;
  Reset    : BOOL;
END_VAR
VAR_OUTPUT
  Coil     : BOOL;
  Alarm    : BOOL;
  State    : INT;
END_VAR
VAR
  Travel   : TON;
  Moves    : UDINT;
END_VAR
  Travel(IN := State = 1 OR State = 3, PT := T#$ms);
  CASE State OF
    0:  (* closed *)
      Coil := FALSE;
      IF Open AND NOT Alarm THEN
        State := 1;
        Moves := Moves + 1;
      END_IF;
    1:  (* opening *)
      Coil := TRUE;
      IF IsOpen THEN
        State := 2;
      ELSIF Travel.Q THEN
        State := 4;
      END_IF;
    2:  (* open *)
      IF NOT Open THEN
        State := 3;
      END_IF;
    3:  (* closing *)
      Coil := FALSE;
      IF IsClosed THEN
        State := 0;
      ELSIF Travel.Q THEN
        State := 4;
      END_IF;
    4:
      Alarm := TRUE;
      Coil := FALSE;
      IF Reset THEN
        Alarm := FALSE;
        State := 0;
      END_IF;
  ELSE
    State := 0;
  END_CASE;
END_FUNCTION_BLOCK

)",
     "  Valve@_1 : Valve@;\n",
     R"(  Valve@_1(Open := Area%_Enable, IsOpen := Area%_Level > $.5, IsClosed := Area%_Level < 1.5,
         Reset := Area%_Reset);
)"},
    {R"((* A controller with a ramp in front and limits behind. *)
FUNCTION Scaled@ : REAL
VAR_INPUT
  Raw : INT;
  Low, High : REAL;
END_VAR
  Scaled@ := Low + INT_TO_REAL(Raw) * (High - Low) / 27648.0;
END_FUNCTION

FUNCTION_BLOCK Control@
VAR_INPUT
  Raw      : INT;
  Setpoint : REAL;
  Manual   : BOOL;
  Hand     : REAL;
END_VAR
VAR_OUTPUT
  Output   : REAL;
  AtLimit  : BOOL;
END_VAR
VAR
  Actual, Error, LastError : REAL;
  Target, Integral : REAL;
  Gain     : REAL := 1.$;
  Rise     : REAL := 0.$;
END_VAR
  Actual := Scaled@(Raw := Raw, Low := 0.0, High := $.0);
  IF Target < Setpoint - Rise THEN
    Target := Target + Rise;
  ELSIF Target > Setpoint + Rise THEN
    Target := Target - Rise;
  ELSE
    Target := Setpoint;
  END_IF;
  Error := Target - Actual;
  IF Manual THEN
    Output := Hand;
    Integral := Hand;
  ELSE
    Integral := Integral + Error * 0.0$;
    Output := Gain * Error + Integral + (Error - LastError) * 0.1;
  END_IF;
  LastError := Error;
  AtLimit := Output > 100.0 OR Output < 0.0;
  IF AtLimit THEN
    Integral := Integral - Error * 0.05;
  END_IF;
  Output := LIMIT(0.0, Output, 100.0);
END_FUNCTION_BLOCK

)",
     "  Control@_1 : Control@;\n",
     R"(  Control@_1(Raw := DINT_TO_INT(Area%_Count), Setpoint := $.5, Manual := Area%_Stop, Hand := 0.0);
  Area%_Level := Area%_Level * 0.9 + Control@_1.Output * 0.1;
)"},
    {R"((* Fills, heats, empties: a sequence with a timer of its own. *)
FUNCTION_BLOCK Sequence@
VAR_INPUT
  Start, Abort : BOOL;
  Level    : REAL;
  Settle   : TIME := T#$ms;
END_VAR
VAR_OUTPUT
  Inlet, Heater, Outlet, Busy : BOOL;
  Step     : INT;
  Batches  : UDINT;
END_VAR
VAR
  Wait     : TON;
  LastStep : INT;
  Pause    : TIME;
END_VAR
  Wait(IN := Step = LastStep, PT := Pause);
  LastStep := Step;
  IF Abort THEN
    Step := 90;
  END_IF;
  CASE Step OF
    0:
      Inlet := FALSE; Heater := FALSE; Outlet := FALSE;
      IF Start THEN
        Step := 10;
      END_IF;
    10:
      Inlet := TRUE;
      IF Level >= $.0 THEN
        Inlet := FALSE;
        Pause := Settle;
        Step := 20;
      END_IF;
    20, 21:
      IF Wait.Q THEN
        Heater := TRUE;
        Pause := Settle * 3;
        Step := 30;
      END_IF;
    30..39:
      IF Wait.Q THEN
        Heater := FALSE;
        Step := 40;
      END_IF;
    40:
      Outlet := TRUE;
      IF Level <= 1.0 THEN
        Batches := Batches + 1;
        Step := 0;
      END_IF;
    90:
      Inlet := FALSE; Heater := FALSE;
      Outlet := Level > 1.0;
      IF NOT Abort AND NOT Outlet THEN
        Step := 0;
      END_IF;
  END_CASE;
  Busy := Step <> 0;
END_FUNCTION_BLOCK

)",
     "  Sequence@_1 : Sequence@;\n",
     R"(  Sequence@_1(Start := Area%_Enable AND Area%_Ready, Abort := Area%_Stop, Level := Area%_Level);
  IF Sequence@_1.Busy THEN
    Area%_Count := Area%_Count + 1;
  END_IF;
)"},
    {R"((* Mean, smallest and largest of the last values. *)
FUNCTION_BLOCK Trend@
VAR_INPUT
  Value    : REAL;
  Sample   : BOOL;
END_VAR
VAR_OUTPUT
  Mean, Low, High, Spread : REAL;
  Full     : BOOL;
END_VAR
VAR
  Values   : ARRAY[0..31] OF REAL;
  Sorted   : ARRAY[0..31] OF REAL;
  Next, i, k : INT;
  Sum, Held : REAL;
  Edge     : R_TRIG;
END_VAR
  Edge(CLK := Sample);
  IF NOT Edge.Q THEN
    RETURN;
  END_IF;
  Values[Next] := Value;
  Next := Next + 1;
  IF Next > 31 THEN
    Next := 0;
    Full := TRUE;
  END_IF;
  Sum := 0.0;
  Low := Values[0];
  High := Values[0];
  FOR i := 0 TO 31 DO
    Sum := Sum + Values[i];
    IF Values[i] < Low THEN
      Low := Values[i];
    END_IF;
    High := MAX(High, Values[i]);
    Sorted[i] := Values[i];
  END_FOR;
  Mean := Sum / 32.0;
  FOR i := 1 TO 31 DO
    Held := Sorted[i];
    k := i - 1;
    WHILE k > 0 AND_THEN Sorted[k] > Held DO
      Sorted[k + 1] := Sorted[k];
      k := k - 1;
    END_WHILE;
    Sorted[k + 1] := Held;
  END_FOR;
  Spread := Sorted[24] - Sorted[8] + 0.$;
END_FUNCTION_BLOCK

)",
     "  Trend@_1 : Trend@;\n",
     R"(  Trend@_1(Value := Area%_Level, Sample := Area%_Enable);
)"},
    {R"((* Recipes as structures in an array. *)
TYPE
  Recipe@ : STRUCT
    Number : INT;
    Amount : ARRAY[1..4] OF REAL;
    Speed  : INT;
    Used   : UDINT;
    Valid  : BOOL;
  END_STRUCT;
END_TYPE

FUNCTION_BLOCK Recipes@
VAR_INPUT
  Wanted   : INT;
  Store    : BOOL;
  Speed    : INT;
END_VAR
VAR_OUTPUT
  Current  : Recipe@;
  Found    : BOOL;
  Total    : REAL;
END_VAR
VAR
  List     : ARRAY[1..10] OF Recipe@;
  Place, i : INT;
END_VAR
  Found := FALSE;
  Place := 0;
  FOR i := 1 TO 10 DO
    IF List[i].Valid AND_THEN List[i].Number = Wanted THEN
      Place := i;
      Found := TRUE;
      EXIT;
    END_IF;
  END_FOR;
  IF NOT Found AND Store THEN
    Place := Wanted MOD 10 + 1;
    IF Place < 1 THEN
      Place := 1;
    END_IF;
    List[Place].Number := Wanted;
    List[Place].Speed := Speed;
    List[Place].Valid := TRUE;
    FOR i := 1 TO 4 DO
      List[Place].Amount[i] := INT_TO_REAL(i) * $.5;
    END_FOR;
  END_IF;
  IF Place > 0 THEN
    List[Place].Used := List[Place].Used + 1;
    Current := List[Place];
  END_IF;
  Total := 0.0;
  FOR i := 1 TO 4 DO
    Total := Total + Current.Amount[i];
  END_FOR;
END_FUNCTION_BLOCK

)",
     "  Recipes@_1 : Recipes@;\n",
     R"(  Recipes@_1(Wanted := DINT_TO_INT(Area%_Count MOD 20), Store := Area%_Enable, Speed := $);
)"},
    {R"((* Sixteen alarms: first in, acknowledged, as a word and as a text. *)
FUNCTION_BLOCK Alarms@
VAR_INPUT
  Signals  : WORD;
  Mask     : WORD := 16#FFF0;
  Ack      : BOOL;
END_VAR
VAR_OUTPUT
  Active   : WORD;
  First    : INT := -1;
  Horn     : BOOL;
  Text     : STRING[40];
END_VAR
VAR
  Last, Rising : WORD;
  i, Number : INT;
  Blink    : TON;
END_VAR
  Rising := (Signals AND Mask) AND NOT Last;
  Last := Signals AND Mask;
  Active := Active OR Rising;
  IF Rising <> 0 THEN
    Horn := TRUE;
  END_IF;
  IF Ack THEN
    Horn := FALSE;
    Active := Active AND Last;
    First := -1;
  END_IF;
  Number := 0;
  FOR i := 0 TO 15 DO
    IF (SHR(Active, i) AND 16#1) <> 0 THEN
      Number := Number + 1;
      IF First < 0 THEN
        First := i;
      END_IF;
    END_IF;
  END_FOR;
  Blink(IN := NOT Blink.Q AND Number > 0, PT := T#$ms);
  IF Number = 0 THEN
    Text := 'no alarm';
  ELSIF Blink.Q THEN
    Text := CONCAT('alarm ', INT_TO_STRING(First + $));
  END_IF;
END_FUNCTION_BLOCK

)",
     "  Alarms@_1 : Alarms@;\n",
     R"(  Alarms@_1(Signals := DINT_TO_WORD(Area%_Count), Ack := Area%_Reset);
)"},
};
