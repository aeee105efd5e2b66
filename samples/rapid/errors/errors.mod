MODULE Errors
  ! What error handlers do: try again, go on behind the failed statement, return, pass on to the caller, book a number.
  ! Expected: each output comes on once, in order; doWrong stays off.

  VAR num nCalls:=0;
  VAR errnum ERR_BOOKED:=-1;

  PROC main()
    VAR num nValue;

    BookErrNo ERR_BOOKED;
    nCalls:=0;
    Stubborn;
    IF nCalls=3 Set doRetried;
    Careless;
    nValue:=Guarded(2);
    IF nValue=2 nValue:=Guarded(4);
    IF nValue=14 Set doReturned;
    nValue:=0;
    Outer;
    IF ERR_BOOKED=-1 Set doWrong;
    Deadline;
  ENDPROC

  ! Succeeds at the third try: RETRY executes the failed statement again. Errors of another number are passed on.
  PROC Stubborn()
    Fail;
  ERROR
    IF ERRNO=11 RETRY;
    RAISE;
  ENDPROC

  PROC Fail()
    Incr nCalls;
    IF nCalls<3 RAISE 11;
    IF nCalls>3 RAISE ERR_BOOKED;
  ENDPROC

  ! TRYNEXT goes on behind the failed statement.
  PROC Careless()
    nCalls:=0;
    Fail;
    Set doWentOn;
  ERROR
    TRYNEXT;
  ENDPROC

  ! The handler of a function gives the value instead.
  FUNC num Guarded(num nNumber)
    nCalls:=2;
    IF nNumber>3 RAISE 12;
    RETURN nNumber;
  ERROR
    IF ERRNO=12 RETURN nNumber+10;
  ENDFUNC

  ! An error without a handler, or one that is raised again, goes to the caller.
  PROC Outer()
    Middle;
    Set doWrong;
  ERROR (ERR_BOOKED)
    Set doPassedOn;
    RETURN;
  ENDPROC

  PROC Middle()
    nCalls:=3;
    Stubborn;
  ERROR
    Set doSeen;
    RAISE;
  ENDPROC

  ! A wait that ends by its time limit is an error too.
  PROC Deadline()
    WaitDI diNever,1\MaxTime:=1;
    Set doWrong;
  ERROR (ERR_WAIT_MAXTIME)
    Set doTooLate;
    RETURN;
  ENDPROC
ENDMODULE
