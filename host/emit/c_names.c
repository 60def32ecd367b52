/* c_names.c: names that generated C cannot give to a scene, since its readers have them already.
 *
 * A scene is a global object, and its name stands in whoever's program, between whatever headers that includes. Any
 * name of C's library would do harm there: a declaration of it that a header makes, a macro, a function that the
 * compiler knows without any header ("conflicting types for built-in function"), a definition that the linker
 * takes for the library's own. tests/host/test_c_names.c asks the compilers. */
#include <ctype.h>
#include <string.h>

#include "emit.h"

/* Keywords, up to C23. */
static const char words_of_c[] =
    "alignas alignof asm auto bool break case char const constexpr continue default do double "
    "else enum extern false float for goto if inline int long nullptr register restrict "
    "return short signed sizeof static static_assert struct switch thread_local true typedef "
    "typeof typeof_unqual union unsigned void volatile while";

/* Those that C does not have, up to C++20, with the functions that a compiler of coroutines knows. */
static const char words_of_cpp[] =
    "and and_eq bitand bitor catch char8_t class co_await co_return co_yield compl concept "
    "const_cast consteval constinit coro_destroy coro_done coro_promise coro_resume decltype delete dynamic_cast explicit export friend "
    "mutable namespace new noexcept not not_eq operator or or_eq private protected public "
    "reinterpret_cast requires static_cast std template this throw try typeid typename using "
    "virtual xor xor_eq";

/* What a generated file has for itself: objects and functions. (It declares its scene behind all of them: what is named
 * within functions is free.) */
static const char own[] =
    "main accelerations slopes step_matrix one_step advance ahead observe start_angle start_real "
    "start_input contacts contact_signals contact_forces contact_sets contact_table "
    "contact_target ledger ledger_powers ledger_levels ledger_accounts ledger_inputs waves "
    "wave_sines wave_rates "
    "WH";

/* Macros that a GNU dialect begins with, for one target or another. */
static const char predefined[] =
    "AVR MIPSEB MIPSEL WIN32 WINNT i386 linux mc68000 mips sparc sun unix";

/* Of <math.h> and <complex.h>: each has variants for other types. */
static const char maths[] =
    "M_1_PI M_2_PI M_2_SQRTPI M_E M_LN10 M_LN2 M_LOG10E M_LOG2E M_PI M_PI_2 M_PI_4 M_SQRT1_2 "
    "M_SQRT2 acos acosh acospi asin asinh asinpi atan atan2 atan2pi atanh atanpi cabs cacos "
    "cacosh canonicalize carg casin casinh catan catanh cbrt ccos ccosh ceil cexp cimag clog "
    "clog10 compoundn conj copysign cos cosh cospi cpow cproj creal csin csinh csqrt ctan "
    "ctanh drem erf erfc exp exp10 exp10m1 exp2 exp2m1 expm1 fabs fadd fdim fdiv ffma finite "
    "floor fma fmax fmaximum fmaximum_mag fmaximum_mag_num fmaximum_num fmaxmag fmin fminimum "
    "fminimum_mag fminimum_mag_num fminimum_num fminmag fmod fmul frexp fromfp fromfpx fsqrt "
    "fsub gamma gamma_r getpayload hypot ilogb isinf isnan j0 j1 jn ldexp lgamma lgamma_r "
    "llogb llrint llround log log10 log10p1 log1p log2 log2p1 logb logp1 lrint lround modf "
    "nan nearbyint nextafter nextdown nexttoward nextup pow pow10 pown powr quantize "
    "remainder remquo rint rootn round roundeven rsqrt samequantum scalb scalbln scalbn "
    "setpayload setpayloadsig signbit significand sin sincos sinh sinpi sqrt tan tanh tanpi "
    "tgamma totalorder totalordermag trunc ufromfp ufromfpx y0 y1 yn";

/* All else that headers have: types, macros, objects, */
static const char types_and_macros[] =
    "BIG_ENDIAN BUFSIZ CHAR_BIT CHAR_MAX CHAR_MIN CLOCKS_PER_SEC DECIMAL_DIG EDOM EILSEQ EOF "
    "ERANGE EXIT_FAILURE EXIT_SUCCESS FD_SETSIZE FILE FILENAME_MAX FOPEN_MAX HUGE_VAL "
    "HUGE_VALF HUGE_VALL I INFINITY LITTLE_ENDIAN LLONG_MAX LLONG_MIN LONG_MAX LONG_MIN "
    "BYTE_ORDER L_tmpnam SIG_ATOMIC_MAX SIG_ATOMIC_MIN MATH_ERREXCEPT MATH_ERRNO MB_CUR_MAX MB_LEN_MAX NAN NFDBITS NULL ONCE_FLAG_INIT "
    "PDP_ENDIAN PTRDIFF_MAX PTRDIFF_MIN RAND_MAX SCHAR_MAX SCHAR_MIN SEEK_CUR SEEK_END "
    "SEEK_SET SHRT_MAX SHRT_MIN SIGABRT SIGFPE SIGILL SIGINT SIGSEGV SIGTERM SIG_DFL SIG_ERR "
    "SIG_IGN SIZE_MAX TIME_UTC TMP_MAX TSS_DTOR_ITERATIONS UCHAR_MAX ULLONG_MAX ULONG_MAX "
    "USHRT_MAX WCHAR_MAX WCHAR_MIN WCONTINUED WEOF WEXITED WINT_MAX WINT_MIN WNOHANG WNOWAIT "
    "WSTOPPED WUNTRACED assert blkcnt_t blksize_t caddr_t char16_t char32_t clock_t clockid_t "
    "complex daddr_t dev_t div_t double_t errno fd_mask fd_set fenv_t fexcept_t float_t "
    "fpos_t fsblkcnt_t fsfilcnt_t fsid_t gid_t id_t imaxdiv_t ino_t intmax_t intptr_t jmp_buf "
    "key_t ldiv_t lldiv_t locale_t loff_t math_errhandling max_align_t mbstate_t memory_order "
    "mode_t nlink_t noreturn off_t offsetof once_flag pid_t ptrdiff_t quad_t register_t "
    "sig_atomic_t sigjmp_buf sigset_t size_t ssize_t stderr stdin stdout suseconds_t time_t "
    "timer_t u_char u_int u_int16_t u_int32_t u_int64_t u_int8_t u_long u_quad_t u_short "
    "uid_t uint uintmax_t uintptr_t ulong unreachable ushort va_copy va_end va_list va_start "
    "wchar_t wctrans_t wctype_t wint_t";

/* and functions; with those that only compilers know by their names. */
static const char functions[] =
    "a64l abort abs aligned_alloc alloca arc4random arc4random_buf arc4random_uniform asctime "
    "asctime_r at_quick_exit atexit atof atoi atol atoll bcmp bcopy bsearch btowc bzero "
    "c16rtomb c32rtomb call_once calloc clearenv clearerr clock ctime ctime_r dcgettext "
    "dgettext difftime div drand48 drand48_r ecvt ecvt_r erand48 erand48_r execl execle "
    "execlp execv execve execvp exit explicit_bzero fclose fcvt fcvt_r feclearexcept fegetenv "
    "fegetexceptflag fegetround feholdexcept feof feraiseexcept ferror fesetenv "
    "fesetexceptflag fesetround fetestexcept feupdateenv fflush ffs ffsimax ffsl ffsll fgetc "
    "fgetpos fgets fgetwc fgetws fopen fork fpclassify fprintf fprintf_unlocked fputc "
    "fputc_unlocked fputs fputs_unlocked fputwc fputws fread free free_aligned_sized "
    "free_sized freopen fscanf fseek fsetpos ftell fwide fwprintf fwrite fwrite_unlocked "
    "fwscanf gcvt getc getchar getenv getloadavg getsubopt gettext getwc getwchar gmtime "
    "gmtime_r imaxabs imaxdiv index initstate initstate_r isalnum isalpha isascii isblank "
    "iscanonical iscntrl isdigit iseqsig isfinite isgraph isgreater isgreaterequal isless "
    "islessequal islessgreater islower isnormal isprint ispunct issignaling isspace "
    "issubnormal isunordered isupper iswalnum iswalpha iswblank iswcntrl iswctype iswdigit "
    "iswgraph iswlower iswprint iswpunct iswspace iswupper iswxdigit isxdigit iszero jrand48 "
    "jrand48_r kill_dependency l64a labs lcong48 lcong48_r ldiv llabs lldiv localeconv "
    "localtime localtime_r longjmp lrand48 lrand48_r malloc mblen mbrlen mbrtoc16 mbrtoc32 "
    "mbrtowc mbsinit mbsrtowcs mbstowcs mbtowc memalign memalignment memccpy memchr memcmp "
    "memcpy memmove mempcpy memset memset_explicit mkdtemp mkstemp mkstemps mktemp mktime "
    "mrand48 mrand48_r nanosleep nrand48 nrand48_r on_exit perror posix_memalign printf "
    "printf_unlocked pselect putc putc_unlocked putchar putchar_unlocked putenv puts "
    "puts_unlocked putwc putwchar qecvt qecvt_r qfcvt qfcvt_r qgcvt qsort quick_exit raise "
    "rand rand_r random random_r realloc reallocarray realpath remove rename rewind rindex "
    "rpmatch savectx scanf seed48 seed48_r select setbuf setenv setjmp setlocale setstate "
    "setstate_r setvbuf siglongjmp signal signgam sigsetjmp snprintf sprintf srand srand48 "
    "srand48_r srandom srandom_r sscanf stpcpy stpncpy strcasecmp strcasecmp_l strcat strchr "
    "strcmp strcoll strcoll_l strcpy strcspn strdup strerror strerror_l strerror_r strfmon "
    "strfromd strfromf strfroml strftime strlcat strlcpy strlen strncasecmp strncasecmp_l "
    "strncat strncmp strncpy strndup strnlen strpbrk strrchr strsep strsignal strspn strstr "
    "strtod strtof strtoimax strtok strtok_r strtol strtold strtoll strtoq strtoul strtoull "
    "strtoumax strtouq strxfrm strxfrm_l swprintf swscanf system time timegm timespec_get "
    "timespec_getres tmpfile tmpnam toascii tolower toupper towctrans towlower towupper "
    "ungetc ungetwc unsetenv valloc vfork vfprintf vfscanf vfwprintf vfwscanf vprintf vscanf "
    "vsnprintf vsprintf vsscanf vswprintf vswscanf vwprintf vwscanf wcrtomb wcscat wcschr "
    "wcscmp wcscoll wcscpy wcscspn wcsftime wcslcat wcslcpy wcslen wcsncat wcsncmp wcsncpy "
    "wcspbrk wcsrchr wcsrtombs wcsspn wcsstr wcstod wcstof wcstoimax wcstok wcstol wcstold "
    "wcstoll wcstombs wcstoul wcstoull wcstoumax wcsxfrm wctob wctomb wctrans wctype wmemchr "
    "wmemcmp wmemcpy wmemmove wmemset wprintf wscanf";

/* How whole families begin. */
static const char families[] =
    "FLT_ DBL_ LDBL_ DEC32_ DEC64_ DEC128_ FE_ LC_ FP_ ATOMIC_ atomic_ memory_order_ mtx_ "
    "cnd_ thrd_ tss_ pthread_ stdc_ ckd_ wh_ WH_ _";

/* What stands behind a function's name for another type. */
static const char *const variants[] = {"",     "f",    "l",     "f16",  "f32", "f64", "f128",
                                       "f32x", "f64x", "f128x", "bf16", "d32", "d64", "d128"};

/* The word that `words` begins with; they are parted by spaces. NULL: there is none. */
static const char *next_word(const char *words, size_t *length) {
    words += strspn(words, " ");
    *length = strcspn(words, " ");
    return *length > 0 ? words : NULL;
}

/* Is text[length] one of the words? */
static bool is_among(const char *words, const char *text, size_t length) {
    size_t size;
    for (const char *at = words; (at = next_word(at, &size)) != NULL; at += size) {
        if (size == length && strncmp(at, text, size) == 0) {
            return true;
        }
    }
    return false;
}

static bool begins(const char *name, const char *with) {
    return strncmp(name, with, strlen(with)) == 0;
}

static bool ends(const char *name, const char *in) {
    const size_t length = strlen(name);
    const size_t tail = strlen(in);
    return length > tail && strcmp(name + length - tail, in) == 0;
}

static bool is_in_a_family(const char *name) {
    size_t size;
    for (const char *at = families; (at = next_word(at, &size)) != NULL; at += size) {
        if (strncmp(name, at, size) == 0) {
            return true;
        }
    }
    return false;
}

/* fabs, fabsf, fabsl, fabsf64x; lgammaf_r. */
static bool is_maths(const char *name) {
    const size_t whole = strlen(name);
    const size_t length = ends(name, "_r") ? whole - 2 : whole;
    for (size_t i = 0; i < sizeof variants / sizeof variants[0]; i++) {
        const size_t tail = strlen(variants[i]);
        if (length > tail && strncmp(name + length - tail, variants[i], tail) == 0 &&
            is_among(maths, name, length - tail)) {
            return true;
        }
    }
    return false;
}

/* int8_t, uint_fast16_t, INT8_C, UINT_LEAST16_MAX, PRIdPTR. */
static bool is_of_integers(const char *name) {
    const bool format = begins(name, "PRI") || begins(name, "SCN");
    const char *upper = name + (name[0] == 'U');
    const char *lower = name + (name[0] == 'u');
    if (begins(lower, "int")) {
        lower += strlen("int");
        lower += begins(lower, "_least")  ? strlen("_least")
                 : begins(lower, "_fast") ? strlen("_fast")
                                          : 0;
        return isdigit((unsigned char)lower[0]) && ends(lower, "_t");
    }
    return (begins(upper, "INT") && (ends(upper, "_MAX") || ends(upper, "_MIN") ||
                                     ends(upper, "_C") || ends(upper, "_WIDTH"))) ||
           (format && name[3] != '\0' && strchr("bBdiouxX", name[3]) != NULL && name[4] != '\0' &&
            strchr("0123456789LFMP", name[4]) != NULL);
}

bool emit_c_name_is_free(const char *name) {
    const size_t length = strlen(name);
    return !is_among(words_of_c, name, length) && !is_among(own, name, length) &&
           !is_among(predefined, name, length) && !is_among(types_and_macros, name, length) &&
           !is_among(functions, name, length) && !is_maths(name) && !is_of_integers(name) &&
           !is_in_a_family(name);
}

bool emit_c_name_is_free_in_cpp(const char *name) {
    return !is_among(words_of_cpp, name, strlen(name));
}
